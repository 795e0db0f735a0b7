#include "heading/expansion_fit.h"

#include <string.h>

#include "heading/flow_field.h"

#define FOCUS_LIMIT_Q24 (INT32_C(1) << 24)
#define TURN_LIMIT_Q24 (INT32_C(1) << 22)
#define R_MIN_Q16 256 /* nearer to the focus than this a flow tells nothing: 2 px at a focal length of 500 px */
#define NOISE_BINS ((unsigned)ROADPOSE_NOISE_BINS)
#define FEW_FLOWS 64u /* a coarse round looks at no fewer */
#define CUT_QUARTERS 14 /* Tukey's biweight ends at 3.5 standard deviations */

/* Where Tukey's biweight ends, and 2^30 over it: noise <= 1.5 px at f = 50 px, 2^17, so the cut is below 2^19. */
typedef struct {
    int32_t q22;
    int32_t inverse;
} cut_t;

/* A motion, prepared for looking at many flows. */
typedef struct {
    int32_t fx_q16;
    int32_t fy_q16;
    int32_t turn_q28[3]; /* |turn| <= 2^26 */
    bool turns;
    int32_t short_q22; /* flows shorter than this may point anywhere */
    cut_t cut;
} view_t;

/* One flow seen from the focus. */
typedef struct {
    int32_t nx_q30; /* direction from the focus, of length 1 to 7 %, shorter near the focus */
    int32_t ny_q30;
    int32_t dx_q22;
    int32_t dy_q22;
    int32_t inverse_q14; /* 1 / r */
    int32_t e_q22;       /* flow across that direction */
    int32_t off_q22;     /* |e| */
    bool outward;        /* streams away from the focus, or is too short to tell */
} sight_t;

int32_t roadpose_noise_min_q22(const roadpose_heading_t *instance) {
    return instance->lens.px_q22 * 2 / 25;
}

int32_t roadpose_noise_max_q22(const roadpose_heading_t *instance) {
    return instance->lens.px_q22 * 3 / 2;
}

static cut_t cut_of(int32_t noise_q22) {
    const int32_t q22 = noise_q22 * CUT_QUARTERS / 4;
    return (cut_t){q22, (INT32_C(1) << 30) / q22};
}

static view_t view_of(const roadpose_expansion_t *motion, int32_t noise_q22) {
    const int32_t *turn = motion->turn_q24;
    return (view_t){roadpose_floor_shift32(motion->focus_q24[0], 8),
                    roadpose_floor_shift32(motion->focus_q24[1], 8),
                    {turn[0] * 16, turn[1] * 16, turn[2] * 16},
                    (turn[0] | turn[1] | turn[2]) != 0,
                    3 * noise_q22,
                    cut_of(noise_q22)};
}

/* |m| <= 2 + 1 (q16 < 2^17.6); |d| < 2^23.8 in q22; r >= 2^8, so 1/r <= 2^22 and, r being never more than 3 % short,
 * |n| <= 1.04 * 2^30 < 2^31; products with d below 2^55. r is at least twice the flow's longer side: a longer flow
 * reaches behind the focus. */
static sight_t look(const roadpose_flow_t *flow, const view_t *view, const roadpose_turn_terms_t *terms) {
    sight_t s;
    s.dx_q22 = flow->dx_q22;
    s.dy_q22 = flow->dy_q22;
    if (view->turns) {
        int32_t turned_q22[2];
        roadpose_turn_flow(terms, view->turn_q28, turned_q22);
        s.dx_q22 -= turned_q22[0];
        s.dy_q22 -= turned_q22[1];
    }
    const int32_t mx_q16 = flow->mx_q16 - view->fx_q16;
    const int32_t my_q16 = flow->my_q16 - view->fy_q16;
    const int32_t side_q22 = roadpose_longer_side(s.dx_q22, s.dy_q22);
    const int32_t r = roadpose_length(mx_q16, my_q16);
    const int32_t longer = (r > (side_q22 >> 5)) ? r : (side_q22 >> 5);
    s.inverse_q14 = (int32_t)((UINT32_C(1) << 30) / (uint32_t)((longer > R_MIN_Q16) ? longer : R_MIN_Q16));
    s.nx_q30 = mx_q16 * s.inverse_q14;
    s.ny_q30 = my_q16 * s.inverse_q14;
    s.e_q22 = (int32_t)roadpose_floor_shift((int64_t)s.nx_q30 * s.dy_q22 - (int64_t)s.ny_q30 * s.dx_q22, 30);
    s.off_q22 = (s.e_q22 < 0) ? -s.e_q22 : s.e_q22;
    s.outward = side_q22 < view->short_q22 || (int64_t)s.nx_q30 * s.dx_q22 + (int64_t)s.ny_q30 * s.dy_q22 > 0;
    return s;
}

/* 1 - (e / cut)^2 in q12, for |e| < cut: e * 2^30 / cut <= 2^30. */
static int32_t rest_q12(int32_t off_q22, cut_t cut) {
    const int32_t u_q12 = (int32_t)((uint32_t)off_q22 * (uint32_t)cut.inverse >> 18);
    return 4096 - (u_q12 * u_q12 >> 12);
}

/* Derivatives of -e, q16. By the focus, times 16: the flow along the direction from the focus over r, at right angles to
 * that direction. r is at least twice the flow's longer side, and a component of its projection at most (1 + sqrt(2)) / 2
 * times 1.07^2 of that side: below 0.7, so q31 < 2^31, and times 16 in q16 < 2^19.5. The flow across must not enter: it is
 * the error e itself, and its square would draw the focus to the side where most tracks are. What is along (nx, ny) is d
 * less e times (-ny, nx): |e| < 2^25, |n| <= 1.04 * 2^30.
 * By the rotation: the direction across times the turn flow of one radian, |.| <= 1.04 * 6.4 < 8. */
static void focus_row(const sight_t *s, int32_t *j_q16) {
    const int32_t along_x_q22 = s->dx_q22 + (int32_t)roadpose_floor_shift((int64_t)s->e_q22 * s->ny_q30, 30);
    const int32_t along_y_q22 = s->dy_q22 - (int32_t)roadpose_floor_shift((int64_t)s->e_q22 * s->nx_q30, 30);
    j_q16[0] = roadpose_floor_shift32(roadpose_floor_shift32(along_y_q22, 5) * s->inverse_q14, 11);
    j_q16[1] = -roadpose_floor_shift32(roadpose_floor_shift32(along_x_q22, 5) * s->inverse_q14, 11);
}

/* q30 * q26 to q16 */
static int32_t across(const sight_t *s, int32_t u_q26, int32_t v_q26) {
    const int64_t q56 = (int64_t)s->nx_q30 * v_q26 - (int64_t)s->ny_q30 * u_q26;
    return roadpose_floor_shift32((int32_t)roadpose_floor_shift(q56, 32), 8);
}

/* Rotations in the order x, z, y. */
static void turn_row(const sight_t *s, const roadpose_turn_terms_t *t, int32_t *j_q16) {
    j_q16[0] = across(s, t->xy_q26, t->yy_q26);
    j_q16[1] = across(s, t->y_q26, -t->x_q26);
    j_q16[2] = across(s, -t->xx_q26, -t->xy_q26);
}

/* Median of |e| from its histogram below `limit` = four times the noise so far, linear within its bin, times 1.4826. */
static int32_t noise_of_histogram(const uint16_t *bins, int32_t total, int32_t limit_q22) {
    int32_t below = 0;
    int32_t bin = 0;
    while (2 * (below + bins[bin]) < total) {
        below += bins[bin];
        bin++;
    }
    const int32_t into_q8 = (total - 2 * below) * 256 / (2 * bins[bin]);
    /* limit <= 2^19.1, (bin * 256 + into) <= 2^14; 1518 / 1024 */
    const int64_t median = ((int64_t)bin * 256 + into_q8) * limit_q22;
    return (int32_t)roadpose_floor_shift(median * 1518, 24);
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
    const int32_t noise = noise_of_histogram(histogram->bins, (int32_t)histogram->total, histogram->limit_q22);
    return (int32_t)roadpose_clamp(noise, roadpose_noise_min_q22(instance), roadpose_noise_max_q22(instance));
}

/* Sums, agreement, noise and cost at *fit. Cost of a flow (Tukey's): (1 - (1 - u^2)^3) * cut^2 / 3 in noise^2, 512 times
 * 2^12 < 2^22, times 1045 < 2^32. */
static void pass(roadpose_heading_t *instance, const roadpose_fit_t *fit, unsigned unknowns, unsigned stride) {
    roadpose_round_t *round = &instance->round;
    histogram_t histogram = histogram_of(instance, fit->noise_q22);
    const view_t view = view_of(&fit->motion, fit->noise_q22);
    const bool turning = unknowns == ROADPOSE_UNKNOWNS_MOTION;
    unsigned agreeing = 0;
    uint32_t cost_q12 = 0;
    memset(&round->sums, 0, sizeof round->sums);
    for (unsigned i = 0; i < instance->flows; i += stride) {
        const roadpose_flow_t *flow = &instance->flow[i];
        roadpose_turn_terms_t terms;
        if (turning || view.turns) {
            terms = roadpose_turn_terms(flow->mx_q16, flow->my_q16);
        }
        const sight_t s = look(flow, &view, &terms);
        cost_q12 += 4096;
        if (!s.outward) {
            continue;
        }
        histogram_add(&histogram, s.off_q22);
        if (s.off_q22 >= view.cut.q22) {
            continue;
        }
        int32_t j_q16[ROADPOSE_UNKNOWNS_MOTION];
        const int32_t rest = rest_q12(s.off_q22, view.cut);
        const int32_t weight = rest * rest >> 16;
        agreeing += (i < instance->flows_moving && s.off_q22 <= view.short_q22) ? 1u : 0u;
        cost_q12 -= (uint32_t)(weight * rest >> 8);
        if (unknowns == 0) {
            continue;
        }
        focus_row(&s, j_q16);
        roadpose_sums_add_focus(&round->sums, j_q16, s.e_q22, weight);
        if (turning) {
            turn_row(&s, &terms, &j_q16[ROADPOSE_UNKNOWNS_FOCUS]);
            roadpose_sums_add_turn(&round->sums, j_q16, s.e_q22, weight);
        }
    }
    round->agreeing = (uint16_t)agreeing;
    round->cost_q8 = (int32_t)((uint64_t)cost_q12 * ROADPOSE_COST_OUTLIER_Q8 >> 12);
    round->noise_q22 = noise_of(instance, &histogram, fit->noise_q22);
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

void roadpose_fit_focus_alone(roadpose_heading_t *instance, roadpose_fit_t *fit) {
    int32_t x_q28[ROADPOSE_UNKNOWNS_FOCUS];
    instance->round.factors.unknowns = ROADPOSE_UNKNOWNS_FOCUS;
    roadpose_solve(&instance->round.factors, x_q28);
    step_focus(&fit->motion, x_q28);
    fit->noise_q22 = instance->round.noise_q22;
}

bool roadpose_fit_rounds(roadpose_heading_t *instance, roadpose_fit_t *fit, unsigned unknowns, unsigned rounds) {
    const unsigned stride = (instance->flows < 2u * FEW_FLOWS) ? 1u : instance->flows / FEW_FLOWS;
    bool told = true;
    for (unsigned round = 0; told && round < rounds; round++) {
        told = roadpose_fit_round(instance, fit, unknowns, stride);
    }
    return told;
}

int32_t roadpose_fit_cost(roadpose_heading_t *instance, const roadpose_fit_t *fit) {
    pass(instance, fit, 0, 1);
    return instance->round.cost_q8;
}
