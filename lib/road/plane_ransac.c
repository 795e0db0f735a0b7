#include "road/plane_ransac.h"

#include "fixed_point/fixed_point.h"

/* A pair agrees with a slope when its second point is at most three pixel rows off the line through its first: about
 * 3 sigma for a disparity noise of 0.2 px and 5 rows a level. */
#define SLOPE_TOLERANCE_Q16 (3 * 65536 / ROADPOSE_ROW_STEP)
/* A pair agrees with an intercept line when its disparity is at most one pixel off it. */
#define LEVEL_TOLERANCE_Q8 256
/* Pairs that are scored before the question whether the hypothesis can still win. */
#define PAIRS_A_LOOK 64
#define PAIR_SCORE_MAX 3
/* Two pairs whose intercepts are closer than this many pixel rows draw no line. */
#define INTERCEPTS_APART_PX 16

/* Rows by which pair k misses the slope, Q16. |dy| <= 2^10, |s| < 2^20 (roadpose_plane_box), |dx| <= 2^10: < 2^31. */
static inline int32_t slope_error_q16(const roadpose_cloud_t *cloud, uint16_t k, int32_t slope_q16) {
    const int32_t error = cloud->dy[k] * 65536 - slope_q16 * cloud->dx[k];
    return (error < 0) ? -error : error;
}

/* A close hit counts more, so that the middle of a crowd wins over its edge. */
static inline int32_t pair_score(int32_t error, int32_t tolerance) {
    return ((error <= tolerance) ? 1 : 0) + ((error <= tolerance / 3) ? PAIR_SCORE_MAX - 1 : 0);
}

/* End of the pairs to score next; `first` itself where a full score for all that are left would not win. */
static uint16_t next_look(uint16_t first, uint16_t pairs, int32_t score, int32_t best_score) {
    const int32_t left = pairs - first;
    if (score + left * PAIR_SCORE_MAX <= best_score) {
        return first;
    }
    return (uint16_t)((left < PAIRS_A_LOOK) ? pairs : first + PAIRS_A_LOOK);
}

/* Score of a slope, <= 1024 pairs * 3; less than it deserves where it cannot win. */
static int32_t score_slope(const roadpose_cloud_t *cloud, int32_t slope_q16, int32_t best_score) {
    int32_t score = 0;
    uint16_t k = 0;
    uint16_t end = next_look(0, cloud->pairs, score, best_score);
    while (k < end) {
        for (; k < end; k++) {
            score += pair_score(slope_error_q16(cloud, k, slope_q16), SLOPE_TOLERANCE_Q16);
        }
        end = next_look(k, cloud->pairs, score, best_score);
    }
    return score;
}

void roadpose_slope_try(const roadpose_cloud_t *cloud, const roadpose_plane_box_t *box, uint32_t *random,
                        int32_t *best_q16, int32_t *best_score) {
    const uint32_t drawn = roadpose_lcg_below(random, cloud->pairs); /* pairs >= 1; dx is never 0 */
    const int32_t slope_q16 = cloud->dy[drawn] * 65536 / cloud->dx[drawn];
    if (slope_q16 > box->slope_max_q16 || slope_q16 < -box->slope_max_q16) {
        return;
    }
    const int32_t score = score_slope(cloud, slope_q16, *best_score);
    if (score > *best_score) {
        *best_score = score;
        *best_q16 = slope_q16;
    }
}

/* Intercept t = y - s x of the line through the middle of pair k. |y_sum|, |x_sum| <= 2^11: sum below 2^32. */
static int32_t intercept_q9(const roadpose_cloud_t *cloud, uint16_t k, int32_t slope_q16) {
    const int64_t twice_q16 = (int64_t)cloud->y_sum[k] * 65536 - (int64_t)slope_q16 * cloud->x_sum[k];
    return (int32_t)roadpose_floor_shift(twice_q16, 8);
}

static uint16_t keep_agreeing(roadpose_cloud_t *cloud, int32_t slope_q16) {
    uint16_t kept = 0;
    for (uint16_t k = 0; k < cloud->pairs; k++) {
        if (slope_error_q16(cloud, k, slope_q16) <= SLOPE_TOLERANCE_Q16) {
            cloud->intercept_q9[kept] = intercept_q9(cloud, k, slope_q16);
            cloud->level_q8[kept] = cloud->level_q8[k];
            kept++;
        }
    }
    cloud->pairs = kept; /* from here on only level_q8 and intercept_q9 are of use */
    return kept;
}

uint16_t roadpose_slope_fit(roadpose_cloud_t *cloud, const roadpose_plane_box_t *box, int32_t *slope_q16) {
    int64_t xx = 0; /* <= 2^10 pairs * 2^20 */
    int64_t xy = 0;
    for (uint16_t k = 0; k < cloud->pairs; k++) {
        if (slope_error_q16(cloud, k, *slope_q16) <= SLOPE_TOLERANCE_Q16) {
            xx += (int64_t)cloud->dx[k] * cloud->dx[k];
            xy += (int64_t)cloud->dx[k] * cloud->dy[k];
        }
    }
    if (xx > 0) {
        *slope_q16 = (int32_t)roadpose_clamp(xy * 65536 / xx, -box->slope_max_q16, box->slope_max_q16);
    }
    return keep_agreeing(cloud, *slope_q16);
}

/* Disparity, Q8, by which kept pair k misses the line. |b| < 2^31, |t| < 2^24, |c| <= 2^41: sum below 2^56. */
static inline int64_t level_error_q8(const roadpose_cloud_t *cloud, uint16_t k, const roadpose_plane_t *plane) {
    const int64_t on_line = (int64_t)plane->b_q24 * cloud->intercept_q9[k] + plane->c_q24 * 512;
    return cloud->level_q8[k] - roadpose_floor_shift(on_line, 25);
}

static bool line_through(const roadpose_cloud_t *cloud, uint16_t first, uint16_t second, roadpose_plane_t *plane) {
    const int64_t t1 = cloud->intercept_q9[first];
    const int64_t t2 = cloud->intercept_q9[second];
    if (roadpose_abs(t2 - t1) < (int64_t)INTERCEPTS_APART_PX * 512 / ROADPOSE_ROW_STEP) {
        return false;
    }
    /* levels Q8 over rows Q9, to Q24: 2^(24 - 8 + 9) */
    const int64_t levels = (int64_t)cloud->level_q8[second] - cloud->level_q8[first];
    plane->b_q24 = roadpose_clamp32(roadpose_ratio(levels, t2 - t1, 25));
    plane->c_q24 = (int64_t)cloud->level_q8[first] * 65536 - roadpose_floor_shift(plane->b_q24 * t1, 9);
    return true;
}

/* d = b (y - s x) + c, so a = -b s. */
static void add_roll(roadpose_plane_t *plane, int32_t slope_q16) {
    plane->a_q24 = roadpose_clamp32(-roadpose_floor_shift((int64_t)plane->b_q24 * slope_q16, 16));
}

/* Like score_slope(). Errors are saturated: what is beyond the tolerance is all the same. */
static int32_t score_intercepts(const roadpose_cloud_t *cloud, const roadpose_plane_t *plane, int32_t best_score) {
    int32_t score = 0;
    uint16_t k = 0;
    uint16_t end = next_look(0, cloud->pairs, score, best_score);
    while (k < end) {
        for (; k < end; k++) {
            const int64_t error = roadpose_abs(level_error_q8(cloud, k, plane));
            score += pair_score((int32_t)roadpose_clamp(error, 0, LEVEL_TOLERANCE_Q8 + 1), LEVEL_TOLERANCE_Q8);
        }
        end = next_look(k, cloud->pairs, score, best_score);
    }
    return score;
}

void roadpose_intercept_try(const roadpose_cloud_t *cloud, const roadpose_plane_box_t *box, int32_t slope_q16,
                            uint32_t *random, roadpose_plane_t *best, int32_t *best_score) {
    const uint16_t first = (uint16_t)roadpose_lcg_below(random, cloud->pairs);
    const uint16_t second = (uint16_t)roadpose_lcg_below(random, cloud->pairs);
    roadpose_plane_t plane = {0, 0, 0};
    if (!line_through(cloud, first, second, &plane) || !roadpose_profile_in_box(&plane, box)) {
        return;
    }
    const int32_t score = score_intercepts(cloud, &plane, *best_score);
    if (score > *best_score) {
        *best_score = score;
        add_roll(&plane, slope_q16);
        *best = plane;
    }
}

uint16_t roadpose_intercept_fit(const roadpose_cloud_t *cloud, int32_t slope_q16, roadpose_plane_t *plane) {
    int64_t n = 0;
    int64_t t_sum = 0; /* Q5 rows: 2^10 pairs * 2^20 */
    int64_t r_sum = 0;
    int64_t tt = 0; /* 2^10 * 2^40 */
    int64_t tr = 0;
    for (uint16_t k = 0; k < cloud->pairs; k++) {
        const int64_t r = level_error_q8(cloud, k, plane);
        if (roadpose_abs(r) <= LEVEL_TOLERANCE_Q8) {
            const int64_t t = roadpose_floor_shift32(cloud->intercept_q9[k], 4);
            n++;
            t_sum += t;
            r_sum += r;
            tt += t * t;
            tr += t * r;
        }
    }
    const int64_t spread = n * tt - t_sum * t_sum; /* <= n * tt < 2^60 */
    if (n < 2 || spread <= 0) {
        return 0;
    }
    /* slope: Q8 per Q5 rows, to Q24 per row: 2^(24 - 8 + 5) */
    const int64_t b = roadpose_clamp(roadpose_ratio(n * tr - t_sum * r_sum, spread, 21), -(1 << 30), 1 << 30);
    plane->c_q24 += (r_sum * 65536 - roadpose_floor_shift(b * t_sum, 5)) / n;
    plane->b_q24 = roadpose_clamp32(plane->b_q24 + b);
    add_roll(plane, slope_q16);
    return (uint16_t)n;
}
