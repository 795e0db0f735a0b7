#include "road/refinement.h"

#include <stddef.h>
#include <string.h>

#include "disparity/ground_range.h"
#include "disparity/road_points.h"
#include "fixed_point/fixed_point.h"
#include "road/ground_plane.h"

/* Wider first: the method before is right to some tenths of a degree. Q8 pixels; then the setting. */
#define FIRST_ROUNDS 3u
static const int16_t FIRST_BANDS_Q8[FIRST_ROUNDS] = {256, 192, 160};

/* The mean residual of a distance may be this share of the noise band: the mean of many points is that much better
 * known than one point. Without it the plane creeps up the foot of a speed bump. */
#define LEVEL_OFFSET_SHARE 3

/* With at least this many points the first rounds look at every eighth row only: 512 points find the plane well
 * enough for the last rounds, which look at all. */
#define POINTS_PLENTY 4096u
#define SPARSE_ROW_STEP 8u

/* The road is uneven at a distance where more than this share of its points near the plane, and more than one, leave the
 * noise band. Fewer are mismatches, and a wider band would only let those in. */
#define UNEVEN_SHARE 16

#define LIMIT_Q18 ((uint32_t)ROADPOSE_MAX_DISPARITY << 18)

/* What changes by 2048 px over the image is no road; and what is beyond 4096 px, to either side, in the middle of a row has
 * no point of that row within the levels. */
#define ACROSS_LIMIT_Q18 (INT32_C(1) << 29)
#define BASE_LIMIT_Q18 (INT64_C(1) << 30)

/* A residual must stay below 4 px: keeps the row sums of residual times column in 32 bits. */
#define BAND_LIMIT_Q8 1023

/* Weights: full inside the corridor's soft edge, half in it. */
#define FULL_WEIGHT 2
#define HALF_WEIGHT 1

/* Root mean square spread, in pixels, below which the points tell no roll (sideways), or no pitch and height (down the
 * image): 96 points with a noise of 0.2 px would leave half a degree. */
#define SPREAD_SIDEWAYS_MIN_PX 20
#define SPREAD_DOWN_MIN_PX 10

#define NO_LIMIT_Q12 (INT32_C(1) << 30)

static int32_t noise_band_q8(uint8_t round, const roadpose_settings_t *settings) {
    const int32_t last = settings->noise_millipx * 256 / 1000;
    const unsigned first = (round == ROADPOSE_LOOK_WIDE) ? 0u : round;
    return (first < FIRST_ROUNDS && FIRST_BANDS_Q8[first] > last) ? FIRST_BANDS_Q8[first] : last;
}

static bool is_uneven(uint8_t round) {
    return (round >= ROADPOSE_UNEVEN_ROUND && round < ROADPOSE_REFINE_ROUNDS) || round == ROADPOSE_LOOK_INNER;
}

uint16_t roadpose_refine_row_step(uint8_t round, uint16_t points) {
    const bool is_sparse = round < ROADPOSE_UNEVEN_ROUND || round == ROADPOSE_LOOK_INNER;
    return (is_sparse && points >= POINTS_PLENTY) ? SPARSE_ROW_STEP : 1u;
}

/* A road point's X in baselines: X / B = (u - cu) / d. The corridor is centred under the rig: a road point
 * straight below it has X = n_x h = B a / k^2, and sideways along the road is X / sqrt(1 - n_x^2). */
bool roadpose_road_rule(roadpose_road_rule_t *rule, const roadpose_plane_t *plane, const roadpose_grid_t *grid,
                        const roadpose_settings_t *settings, uint8_t round) {
    roadpose_pixel_plane_t pixels;
    if (!roadpose_plane_to_pixels(plane, grid, &pixels)) {
        return false;
    }
    const int64_t k = pixels.length_q24;
    rule->a_q18 = (int32_t)roadpose_floor_shift((int64_t)plane->a_q24 + 32, 6);
    if (roadpose_abs(rule->a_q18) * grid->columns >= ACROSS_LIMIT_Q18) {
        return false;
    }
    const int64_t n_x_q16 = roadpose_ratio(pixels.a_q24, k, 16); /* |n_x| <= 1 */
    /* Degenerate planes may have a tiny k: the clamps keep every product below 2^62. */
    rule->centre_q12 = (int32_t)roadpose_clamp(roadpose_ratio(n_x_q16, k, 20), -NO_LIMIT_Q12, NO_LIMIT_Q12);
    const int64_t cosine_q16 = (int64_t)roadpose_sqrt((uint64_t)((INT64_C(1) << 32) - n_x_q16 * n_x_q16));
    const int64_t width_um = (int64_t)settings->corridor_half_width_mm * ((round == ROADPOSE_LOOK_INNER) ? 500 : 1000);
    /* width <= 1e8 um, cosine <= 2^16: product < 2^43; / B >= 20 000 and from Q16 to Q12: < 2^25 */
    const int64_t half_q12 = width_um * cosine_q16 / grid->baseline_um / 16;
    rule->half_outer_q12 = (uint32_t)((width_um == 0) ? NO_LIMIT_Q12 : half_q12 * 9 / 8);
    rule->half_inner_q12 = (uint32_t)((width_um == 0) ? NO_LIMIT_Q12 : half_q12 * 7 / 8);
    rule->range_min_q8 = roadpose_range_min_q8(grid, settings);
    rule->du_q12 = grid->du_millipx * 4096 / 1000; /* |du| <= 8000 */
    rule->noise_q8 = noise_band_q8(round, settings);
    /* unevenness / height = unevenness * k / B; <= 200 000 um * 2^28 / 20 000: the ratio is clamped to 1 */
    const int64_t share = (int64_t)settings->unevenness_mm * 1000 * k / grid->baseline_um;
    rule->unevenness_q16 =
        is_uneven(round) ? (uint32_t)roadpose_clamp(roadpose_floor_shift(share, 8), 0, 65535) : 0u;
    /* The corridor moves with the plane: weigh at the start, and when all rows come in. */
    rule->mark_corridor = round == 0u || round == ROADPOSE_UNEVEN_ROUND || round >= ROADPOSE_REFINE_ROUNDS;
    return true;
}

void roadpose_levels_open(roadpose_moments_t *moments) {
    for (unsigned level = 0; level < ROADPOSE_MAX_DISPARITY; level++) {
        moments->level[level].open = true;
        moments->level[level].uneven = true;
    }
}

/* |r| < 2^10 and at most 2^14 points: the sum and the limit stay below 2^24. */
void roadpose_levels_judge(roadpose_moments_t *moments, const roadpose_settings_t *settings) {
    const int32_t offset_max_q8 = settings->noise_millipx * 256 / 1000 / LEVEL_OFFSET_SHARE;
    for (unsigned i = 0; i < ROADPOSE_MAX_DISPARITY; i++) {
        roadpose_level_t *level = &moments->level[i];
        const int32_t limit = level->on * offset_max_q8;
        level->uneven = (level->off - 1) * UNEVEN_SHARE > level->on + level->off;
        level->open = level->on >= level->off && level->r <= limit && level->r >= -limit;
    }
}

/* Half width of the band in the middle of a level: level < 2^8 and unevenness < 2^16, so below 2^32. */
static int16_t band_of(const roadpose_level_t *level, uint32_t index, const roadpose_road_rule_t *rule) {
    if (!level->open) {
        return -1;
    }
    const uint32_t wider_q8 = level->uneven ? (((index * 256u + 128u) * rule->unevenness_q16) >> 16) : 0u;
    return (int16_t)roadpose_clamp((int64_t)rule->noise_q8 + wider_q8, 0, BAND_LIMIT_Q8);
}

void roadpose_moments_begin(roadpose_moments_t *moments, const roadpose_road_rule_t *rule) {
    const size_t sums = offsetof(roadpose_moments_t, level);
    memset(moments, 0, sums);
    for (uint32_t i = 0; i < ROADPOSE_MAX_DISPARITY; i++) {
        roadpose_level_t *level = &moments->level[i];
        level->band_q8 = band_of(level, i, rule);
        level->on = 0;
        level->off = 0;
        level->r = 0;
    }
}

/* 0 outside the corridor, else the weight. |x| <= 2^10 columns of <= 16 px and |du| <= 8 px in Q12: below 2^27;
 * p < 2^16, centre and halves <= 2^30: products below 2^47. */
static int32_t corridor_weight(const roadpose_road_rule_t *rule, int32_t lateral_px_q12, uint32_t p_q8) {
    const uint64_t off = (uint64_t)roadpose_abs((int64_t)lateral_px_q12 * 256 - (int64_t)rule->centre_q12 * p_q8);
    if (off <= (uint64_t)rule->half_inner_q12 * p_q8) {
        return FULL_WEIGHT;
    }
    return (off <= (uint64_t)rule->half_outer_q12 * p_q8) ? HALF_WEIGHT : 0;
}

/* Sums over one row in which y is constant. At most 1024 points a row, weight <= 2, |x| <= 1024, |r| < 1024:
 * n < 2^12, x < 2^21, r < 2^21, xr <= 2^31 - 2^21, and xx, rr <= 2^31 unsigned. */
typedef struct {
    uint32_t on_road_n; /* points, times 2^16, and their weights n: one addition for both */
    int32_t x, r, xr;
    uint32_t xx, rr;
} row_sums_t;

static void row_sums_flush(roadpose_moments_t *moments, const row_sums_t *sums, int32_t y) {
    const int32_t n = (int32_t)(sums->on_road_n & UINT16_MAX);
    moments->n += n;
    moments->x += sums->x;
    moments->xx += sums->xx;
    moments->r += sums->r;
    moments->xr += sums->xr;
    moments->rr += sums->rr;
    moments->y += (int64_t)n * y;
    moments->yy += (int64_t)n * (y * y); /* |y| <= 2^10 */
    moments->xy += (int64_t)sums->x * y;
    moments->yr += (int64_t)sums->r * y;
    moments->on_road += sums->on_road_n >> 16;
}

static inline void add_point(row_sums_t *sums, uint32_t weight, int32_t x, int32_t r) {
    const int32_t wx = (int32_t)weight * x;
    const int32_t wr = (int32_t)weight * r;
    sums->on_road_n += 65536u + weight;
    sums->x += wx;
    sums->r += wr;
    sums->xr += wx * r;
    sums->xx += (uint32_t)(wx * x);
    sums->rr += (uint32_t)(wr * r);
}

/* The plane along one row: its disparity in column x is base + a x. In 32 bits, for processors on which more is dear: what
 * that cuts off a, at most 2^-19 px a grid step, turns the road by less than a thousandth of a degree. */
typedef struct {
    int32_t base_q18; /* half an LSB of Q8 is in it: it rounds */
    int32_t a_q18;
    int32_t column_0;
} row_plane_t;

/* |b y| < 2^31 * 2^10, |c| <= 2^40. */
static row_plane_t plane_of_row(const roadpose_plane_t *plane, const roadpose_road_rule_t *rule,
                                const roadpose_grid_t *grid, int32_t y) {
    const int64_t base_q18 = roadpose_floor_shift((int64_t)plane->b_q24 * y + plane->c_q24 + (1 << 15), 6);
    const row_plane_t line = {(int32_t)roadpose_clamp(base_q18, -BASE_LIMIT_Q18, BASE_LIMIT_Q18), rule->a_q18,
                              grid->column_0};
    return line;
}

/* Disparity of the plane, Q8. False beyond the levels or above the horizon: the plane is too near to be measured, or
 * behind the camera. |base| <= 2^30, |a x| < 2^29. */
static inline bool plane_at(const row_plane_t *line, int32_t x, uint32_t *p_q8) {
    const uint32_t p_q18 = (uint32_t)(line->base_q18 + line->a_q18 * x); /* negative: beyond the limit */
    *p_q8 = p_q18 >> 10;
    return p_q18 < LIMIT_Q18;
}

/* Weighs the points of a row by the corridor. Points where the plane is too far, above its horizon, or nearer than can
 * be measured get none. */
static void mark_row(roadpose_points_t *points, const roadpose_road_rule_t *rule, const row_plane_t *line, int16_t row) {
    for (uint16_t i = points->row_start[row]; i < points->row_start[row + 1]; i++) {
        const int32_t column = roadpose_point_column(points->column[i]);
        const int32_t x = column - line->column_0;
        uint32_t p_q8;
        int32_t weight = 0;
        if (plane_at(line, x, &p_q8) && (int32_t)p_q8 >= rule->range_min_q8) {
            weight = corridor_weight(rule, x * (ROADPOSE_COLUMN_STEP * 4096) + rule->du_q12, p_q8);
        }
        points->column[i] = (uint16_t)(column | (weight << ROADPOSE_POINT_WEIGHT_SHIFT));
    }
}

static void count_beside(roadpose_moments_t *moments, int32_t r, bool is_closed) {
    if (is_closed) {
        moments->uneven++;
    } else if (r > 0) {
        moments->above++;
    } else {
        moments->below++;
    }
}

/* Where a point of the corridor lies: counts it, and returns whether it takes part in the least squares.
 * r: residual; p: the plane's disparity there, Q8, within the histogram's levels. */
static inline bool sort_point(roadpose_moments_t *moments, int32_t noise_q8, int32_t r, uint32_t p_q8) {
    roadpose_level_t *level = &moments->level[p_q8 >> 8];
    const int32_t distance = (r < 0) ? -r : r;
    if (distance <= noise_q8) {
        level->on++;
        level->r += r;
    } else if (distance <= BAND_LIMIT_Q8) {
        level->off++;
    } else {
        count_beside(moments, r, false);
        return false;
    }
    if (distance <= level->band_q8) {
        return true;
    }
    count_beside(moments, r, level->band_q8 < 0);
    return false;
}

void roadpose_moments_add_row(roadpose_moments_t *moments, roadpose_points_t *points, const roadpose_plane_t *plane,
                              const roadpose_road_rule_t *rule, const roadpose_grid_t *grid, int16_t row) {
    const int32_t y = row - grid->row_0;
    const row_plane_t line = plane_of_row(plane, rule, grid, y);
    const int32_t noise_q8 = rule->noise_q8;
    row_sums_t sums = {0, 0, 0, 0, 0, 0};
    if (rule->mark_corridor) {
        mark_row(points, rule, &line, row);
    }
    const uint16_t end = points->row_start[row + 1];
    for (uint16_t i = points->row_start[row]; i < end; i++) {
        const uint16_t entry = points->column[i];
        const uint32_t weight = roadpose_point_weight(entry);
        const int32_t x = roadpose_point_column(entry) - line.column_0;
        uint32_t p_q8;
        if (weight == 0u || !plane_at(&line, x, &p_q8)) {
            continue; /* the plane may have moved since the mark: its limit guards the levels */
        }
        const int32_t r = (int32_t)points->disparity_q8[i] - (int32_t)p_q8;
        if (sort_point(moments, noise_q8, r, p_q8)) {
            add_point(&sums, weight, x, r);
        }
    }
    row_sums_flush(moments, &sums, y);
}

/* Second moments about the mean, times n^2, cut to 30 bits: n < 2^15 and sums of squares < 2^15 * 2^20, so below 2^51
 * before the cut. It costs 2^-30 of the largest moment, far below the noise, and products stay below 2^60. */
typedef struct {
    int32_t xx, xy, yy, xr, yr;
    int cut;   /* bits cut off xx, xy and yy */
    int cut_r; /* bits cut off xr and yr */
} spread_t;

static int64_t larger(int64_t a, int64_t b) {
    return (a > b) ? a : b;
}

static void spread_about_mean(const roadpose_moments_t *m, spread_t *s) {
    const int64_t xx = m->n * m->xx - m->x * m->x;
    const int64_t yy = m->n * m->yy - m->y * m->y;
    const int64_t xr = m->n * m->xr - m->x * m->r;
    const int64_t yr = m->n * m->yr - m->y * m->r;
    s->cut = (int)roadpose_excess_bits(larger(xx, yy), 30);
    s->cut_r = (int)roadpose_excess_bits(larger(roadpose_abs(xr), roadpose_abs(yr)), 30);
    s->xx = (int32_t)roadpose_scale(xx, -s->cut);
    s->yy = (int32_t)roadpose_scale(yy, -s->cut);
    s->xy = (int32_t)roadpose_scale(m->n * m->xy - m->x * m->y, -s->cut); /* xy^2 <= xx yy */
    s->xr = (int32_t)roadpose_scale(xr, -s->cut_r);
    s->yr = (int32_t)roadpose_scale(yr, -s->cut_r);
}

/* numerator / denominator * 2^bits for bits of either sign. A step of more than 2^30 means nonsense: clamped, and the
 * check of the pose refuses the plane. */
static int64_t slope_step(int64_t numerator, int64_t denominator, int bits) {
    const int64_t whole = roadpose_ratio(numerator, denominator, (unsigned)roadpose_clamp(bits, 0, 40));
    const int64_t step = (bits < 0) ? roadpose_scale(whole, bits) : whole;
    return roadpose_clamp(step, -(INT64_C(1) << 30), INT64_C(1) << 30);
}

/* The 2 x 2 system by Cramer's rule. Results: Q24 pixels per grid step. */
static void solve_slopes(const spread_t *s, bool roll_observed, int64_t *a_q24, int64_t *b_q24) {
    const int bits = 16 + s->cut_r - s->cut; /* residuals are Q8, slopes Q24 */
    if (roll_observed) {
        const int64_t determinant = (int64_t)s->xx * s->yy - (int64_t)s->xy * s->xy;
        *a_q24 = slope_step((int64_t)s->xr * s->yy - (int64_t)s->yr * s->xy, determinant, bits);
        *b_q24 = slope_step((int64_t)s->yr * s->xx - (int64_t)s->xr * s->xy, determinant, bits);
    } else {
        *a_q24 = 0;
        *b_q24 = slope_step(s->yr, s->yy, bits);
    }
}

/* Does the spread of one axis that the other does not explain reach `pixels` (root mean square)? */
static bool spreads(const spread_t *s, int64_t n, int32_t own, int32_t other, int32_t mixed, int32_t pixels,
                    int32_t step_px) {
    const int64_t explained = (other > 0) ? ((int64_t)mixed * mixed / other) : 0;
    const int64_t enough = n * n * pixels * pixels / (step_px * step_px); /* < 2^30 * 400 */
    return own - explained >= roadpose_scale(enough, -s->cut);
}

bool roadpose_refine_step(const roadpose_moments_t *moments, roadpose_plane_t *plane, bool *roll_observed) {
    spread_t s;
    const int64_t n = moments->n;
    spread_about_mean(moments, &s);
    if (n <= 0 || !spreads(&s, n, s.yy, 0, 0, SPREAD_DOWN_MIN_PX, ROADPOSE_ROW_STEP)) {
        return false;
    }
    *roll_observed = spreads(&s, n, s.xx, s.yy, s.xy, SPREAD_SIDEWAYS_MIN_PX, ROADPOSE_COLUMN_STEP);
    int64_t a;
    int64_t b;
    solve_slopes(&s, *roll_observed, &a, &b);
    /* mean residual: r sum in Q8 -> Q24: 2^15 * 2^10 * 2^16; x, y sums < 2^25: a * x < 2^55 */
    const int64_t c = (moments->r * 65536 - a * moments->x - b * moments->y) / n;
    plane->a_q24 = roadpose_clamp32(plane->a_q24 + a);
    plane->b_q24 = roadpose_clamp32(plane->b_q24 + b);
    plane->c_q24 = roadpose_clamp(plane->c_q24 + c, -(INT64_C(1) << 40), INT64_C(1) << 40);
    return true;
}

/* tan(roll) of a plane, Q16. Clamped: what is steeper than 2^12 is no road anyway. */
static int64_t roll_slope_q16(const roadpose_plane_t *plane) {
    const int64_t limit = INT64_C(1) << 28;
    const int64_t slope = roadpose_clamp(roadpose_ratio(plane->a_q24, plane->b_q24, 16), -limit, limit);
    return slope * ROADPOSE_ROW_STEP / ROADPOSE_COLUMN_STEP;
}

bool roadpose_turned_too_far(const roadpose_plane_t *before, const roadpose_plane_t *after, int32_t max_q16) {
    return roadpose_abs(roll_slope_q16(after) - roll_slope_q16(before)) > max_q16;
}
