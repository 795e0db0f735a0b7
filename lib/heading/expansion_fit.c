#include "heading/expansion_fit.h"

#include <string.h>

#include "heading/flow_field.h"

#define FOCUS_LIMIT_Q24 (INT32_C(1) << 24)
#define TURN_LIMIT_Q24 (INT32_C(1) << 22)
#define R_MIN_Q16 256 /* nearer to the focus than this a flow tells nothing: 2 px at a focal length of 500 px */
#define NOISE_BINS ((unsigned)ROADPOSE_NOISE_BINS)
#define FEW_FLOWS 64u /* a coarse round looks at no fewer */
#define CUT_QUARTERS 14 /* Tukey's biweight ends at 3.5 standard deviations */

/* A motion, prepared for looking at many flows. */
typedef struct {
    int32_t fx_q16;
    int32_t fy_q16;
    const int32_t *turn_q24;
    bool turns;
    int32_t short_q22; /* flows shorter than this may point anywhere */
} view_t;

/* One flow seen from the focus. */
typedef struct {
    int32_t mx_q16;
    int32_t my_q16;
    int32_t dx_q22;
    int32_t dy_q22;
    int32_t inverse_q15; /* 1 / r */
    int32_t off_q22;     /* |e| */
    int32_t e_q22;       /* flow across the direction of expansion */
    bool outward;        /* streams away from the focus, or is too short to tell */
} sight_t;

int32_t roadpose_noise_min_q22(const roadpose_heading_t *instance) {
    return instance->lens.px_q22 * 2 / 25;
}

int32_t roadpose_noise_max_q22(const roadpose_heading_t *instance) {
    return instance->lens.px_q22 * 3 / 2;
}

static view_t view_of(const roadpose_expansion_t *motion, int32_t noise_q22) {
    const int32_t *turn = motion->turn_q24;
    return (view_t){roadpose_floor_shift32(motion->focus_q24[0], 8), roadpose_floor_shift32(motion->focus_q24[1], 8),
                    turn, (turn[0] | turn[1] | turn[2]) != 0, 3 * noise_q22};
}

/* |m| <= 2 + 1 (q16 < 2^17.6); |turn flow| <= 2.75, so |d| < 2^23.8 in q22; cross and inner < 2 * 2^41.4; r >= 2^8, so
 * 1/r <= 2^23; e: 2^26.4 * 2^23 < 2^50. r is at least twice the flow's longer side: a longer flow reaches behind the focus. */
static sight_t look(const roadpose_flow_t *flow, const view_t *view) {
    sight_t s;
    int32_t turned[2] = {0, 0};
    if (view->turns) {
        roadpose_turn_flow(flow->mx_q16, flow->my_q16, view->turn_q24, turned);
    }
    s.mx_q16 = flow->mx_q16 - view->fx_q16;
    s.my_q16 = flow->my_q16 - view->fy_q16;
    s.dx_q22 = flow->dx_q22 - turned[0];
    s.dy_q22 = flow->dy_q22 - turned[1];
    const int32_t side_q22 = roadpose_longer_side(s.dx_q22, s.dy_q22);
    const int32_t r = roadpose_length(s.mx_q16, s.my_q16);
    const int32_t longer = (r > (side_q22 >> 5)) ? r : (side_q22 >> 5);
    s.inverse_q15 = (int32_t)((UINT32_C(1) << 31) / (uint32_t)((longer > R_MIN_Q16) ? longer : R_MIN_Q16));
    const int64_t cross_q38 = (int64_t)s.mx_q16 * s.dy_q22 - (int64_t)s.my_q16 * s.dx_q22;
    const int64_t inner_q38 = (int64_t)s.mx_q16 * s.dx_q22 + (int64_t)s.my_q16 * s.dy_q22;
    s.off_q22 = (int32_t)(((roadpose_abs(cross_q38) >> 16) * s.inverse_q15) >> 15);
    s.e_q22 = (cross_q38 < 0) ? -s.off_q22 : s.off_q22;
    s.outward = inner_q38 > 0 || side_q22 < view->short_q22;
    return s;
}

/* Where Tukey's biweight ends, and 2^30 over it: noise <= 1.5 px at f = 50 px, 2^17, so the cut is below 2^19. */
typedef struct {
    int32_t q22;
    int32_t inverse;
} cut_t;

static cut_t cut_of(int32_t noise_q22) {
    const int32_t q22 = noise_q22 * CUT_QUARTERS / 4;
    return (cut_t){q22, (INT32_C(1) << 30) / q22};
}

/* (e / cut)^2 in q24, for |e| < cut: e * 2^30 / cut <= 2^30. */
static int32_t share_q24(int32_t off_q22, cut_t cut) {
    const int32_t u_q12 = (int32_t)((uint32_t)off_q22 * (uint32_t)cut.inverse >> 18);
    return u_q12 * u_q12;
}

/* Tukey's biweight (1 - u^2)^2, q8. */
static int32_t weight_q8(int32_t off_q22, cut_t cut) {
    if (off_q22 >= cut.q22) {
        return 0;
    }
    const int32_t rest_q12 = 4096 - (share_q24(off_q22, cut) >> 12);
    return (rest_q12 * rest_q12) >> 16;
}

/* Derivatives of -e. By the focus, times 16: d / r, each component <= 1/2 as r is at least twice it: q20 <= 2^19. By the rotation: the unit
 * vector across times the turn flow of one radian, |.| <= 1.04 * sqrt(2) * 5 < 8: q16 < 2^19. */
static void focus_row(const sight_t *s, int32_t *j_q16) {
    j_q16[0] = (int32_t)((int64_t)s->dy_q22 * s->inverse_q15 / 131072);
    j_q16[1] = (int32_t)(-(int64_t)s->dx_q22 * s->inverse_q15 / 131072);
}

static int32_t across(const sight_t *s, int64_t u_q16, int64_t v_q16) {
    const int64_t cross_q16 = (s->mx_q16 * v_q16 - s->my_q16 * u_q16) / 65536;
    return (int32_t)(cross_q16 * s->inverse_q15 / 32768);
}

/* Rotations in the order x, z, y. */
static void turn_row(const sight_t *s, const roadpose_flow_t *flow, int32_t *j_q16) {
    const int64_t x = flow->mx_q16;
    const int64_t y = flow->my_q16;
    const int64_t xy = roadpose_floor_shift(x * y, 16);
    j_q16[0] = across(s, xy, 65536 + ((y * y) >> 16));
    j_q16[1] = across(s, y, -x);
    j_q16[2] = across(s, -65536 - ((x * x) >> 16), -xy);
}

/* Median from a histogram of |e| below `limit`, linear within its bin, times 1.4826. */
static int32_t noise_of_histogram(const uint16_t *bins, unsigned total, int32_t limit_q22) {
    unsigned below = 0;
    unsigned bin = 0;
    while (2 * (below + bins[bin]) < total) {
        below += bins[bin];
        bin++;
    }
    const int64_t into_q8 = (int64_t)(total - 2 * below) * 256 / (2 * (int64_t)bins[bin]);
    /* limit <= 2^19.1, (bin * 256 + into) <= 2^14 */
    const int64_t median = ((int64_t)bin * 256 + into_q8) * limit_q22 / (NOISE_BINS * 256);
    return (int32_t)(median * 1518 / 1024);
}

/* Histogram of |e| below four times the noise so far. */
typedef struct {
    uint16_t *bins;
    unsigned total;
    int32_t limit_q22; /* <= 4 * 2^17 */
    uint32_t inverse;  /* 64 * 2^24 over it */
} histogram_t;

static histogram_t histogram_of(roadpose_heading_t *instance, int32_t noise_q22) {
    const int32_t limit_q22 = 4 * noise_q22;
    memset(instance->round.bins, 0, sizeof instance->round.bins);
    return (histogram_t){instance->round.bins, 0, limit_q22, (NOISE_BINS << 24) / (uint32_t)limit_q22};
}

static void histogram_add(histogram_t *histogram, int32_t off_q22) {
    if (off_q22 < histogram->limit_q22) {
        const unsigned bin = (uint32_t)off_q22 * histogram->inverse >> 24; /* e < limit: below 2^30 */
        histogram->bins[bin] = (uint16_t)(histogram->bins[bin] + 1u);
        histogram->total++;
    }
}

static int32_t noise_of(const roadpose_heading_t *instance, const histogram_t *histogram, int32_t noise_q22) {
    if (histogram->total == 0) {
        return noise_q22;
    }
    const int32_t noise = noise_of_histogram(histogram->bins, histogram->total, histogram->limit_q22);
    return (int32_t)roadpose_clamp(noise, roadpose_noise_min_q22(instance), roadpose_noise_max_q22(instance));
}

/* Sums, agreement and noise at *fit. */
static void pass(roadpose_heading_t *instance, const roadpose_fit_t *fit, unsigned unknowns, unsigned stride) {
    histogram_t histogram = histogram_of(instance, fit->noise_q22);
    const cut_t cut = cut_of(fit->noise_q22);
    const view_t view = view_of(&fit->motion, fit->noise_q22);
    unsigned agreeing = 0;
    memset(&instance->round.sums, 0, sizeof instance->round.sums);
    for (unsigned i = 0; i < instance->flows; i += stride) {
        const sight_t s = look(&instance->flow[i], &view);
        if (!s.outward) {
            continue;
        }
        histogram_add(&histogram, s.off_q22);
        agreeing += (i < instance->flows_moving && s.off_q22 <= 3 * fit->noise_q22) ? 1u : 0u;
        const int32_t weight = weight_q8(s.off_q22, cut);
        if (weight == 0) {
            continue;
        }
        int32_t j_q16[ROADPOSE_UNKNOWNS_MOTION];
        focus_row(&s, j_q16);
        if (unknowns == ROADPOSE_UNKNOWNS_MOTION) {
            turn_row(&s, &instance->flow[i], &j_q16[ROADPOSE_UNKNOWNS_FOCUS]);
        }
        roadpose_sums_add(&instance->round.sums, unknowns, j_q16, s.e_q22, weight);
    }
    instance->round.agreeing = (uint16_t)agreeing;
    instance->round.noise_q22 = noise_of(instance, &histogram, fit->noise_q22);
}

/* A focus unknown is a sixteenth of the focus: its q28 is the focus in q24. */
static void step_focus(roadpose_expansion_t *motion, const int32_t *x_q28) {
    for (unsigned i = 0; i < 2; i++) {
        motion->focus_q24[i] = (int32_t)roadpose_clamp((int64_t)motion->focus_q24[i] + x_q28[i], -FOCUS_LIMIT_Q24,
                                                       FOCUS_LIMIT_Q24);
    }
}

static void step_turn(int32_t *turn_q24, int32_t x_q28) {
    *turn_q24 = (int32_t)roadpose_clamp((int64_t)*turn_q24 + roadpose_floor_shift32(x_q28 + 8, 4), -TURN_LIMIT_Q24,
                                        TURN_LIMIT_Q24);
}

bool roadpose_fit_round(roadpose_heading_t *instance, roadpose_fit_t *fit, unsigned unknowns, unsigned stride) {
    int32_t x_q28[ROADPOSE_UNKNOWNS_MOTION];
    pass(instance, fit, unknowns, stride);
    if (!roadpose_factorise(&instance->round.sums, unknowns, &instance->round.factors)) {
        return false;
    }
    const int32_t noise_q22 = instance->round.noise_q22;
    roadpose_solve(&instance->round.factors, x_q28);
    step_focus(&fit->motion, x_q28);
    if (unknowns == ROADPOSE_UNKNOWNS_FOCUS) {
        fit->noise_q22 = noise_q22;
        return true;
    }
    step_turn(&fit->motion.turn_q24[0], x_q28[2]);
    step_turn(&fit->motion.turn_q24[2], x_q28[3]);
    step_turn(&fit->motion.turn_q24[1], x_q28[4]);
    fit->noise_q22 = (noise_q22 < fit->noise_q22) ? noise_q22 : fit->noise_q22;
    return true;
}

bool roadpose_fit_rounds(roadpose_heading_t *instance, roadpose_fit_t *fit, unsigned unknowns, unsigned coarse,
                         unsigned fine) {
    const unsigned stride = (instance->flows < 2u * FEW_FLOWS) ? 1u : instance->flows / FEW_FLOWS;
    bool told = true;
    for (unsigned round = 0; told && round < coarse + fine; round++) {
        told = roadpose_fit_round(instance, fit, unknowns, (round < coarse) ? stride : 1u);
    }
    return told;
}

/* rho = (1 - (1 - u^2)^3) * cut^2 / 3 in noise^2: at most 3.5^2 / 3 = 4.08 (q8: 1045). */
static int32_t cost_q8(int32_t off_q22, cut_t cut) {
    const int64_t rest_q12 = 4096 - (share_q24(off_q22, cut) >> 12);
    const int64_t cube_q12 = (rest_q12 * rest_q12 * rest_q12) >> 24;
    return (int32_t)((4096 - cube_q12) * ROADPOSE_COST_OUTLIER_Q8 / 4096);
}

int64_t roadpose_fit_cost(const roadpose_heading_t *instance, const roadpose_expansion_t *motion, int32_t noise_q22) {
    const cut_t cut = cut_of(noise_q22);
    const view_t view = view_of(motion, noise_q22);
    int64_t sum = 0;
    for (unsigned i = 0; i < instance->flows; i++) {
        const sight_t s = look(&instance->flow[i], &view);
        const bool in = s.off_q22 < cut.q22 && s.outward;
        sum += in ? cost_q8(s.off_q22, cut) : ROADPOSE_COST_OUTLIER_Q8;
    }
    return sum;
}
