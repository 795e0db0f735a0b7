#include "road/plane_ransac.h"

#include "fixed_point/fixed_point.h"

/* A pair agrees with a slope when its second point is at most three pixel rows off the line through its first: about
 * 3 sigma for a disparity noise of 0.2 px and 5 rows a level. */
#define SLOPE_TOLERANCE_Q16 (3 * 65536 / ROADPOSE_ROW_STEP)
/* A pair agrees with an intercept line when its disparity is at most one pixel off it. */
#define LEVEL_TOLERANCE_Q8 256
/* Two pairs whose intercepts are closer than this many pixel rows draw no line. */
#define INTERCEPTS_APART_PX 16

/* Rows by which pair k misses the slope, Q16. |dy| <= 2^11, |s| <= 2^20, |dx| <= 2^11. */
static int64_t slope_error_q16(const roadpose_cloud_t *cloud, uint16_t k, int32_t slope_q16) {
    return roadpose_abs((int64_t)cloud->dy[k] * 65536 - (int64_t)slope_q16 * cloud->dx[k]);
}

void roadpose_slope_try(const roadpose_cloud_t *cloud, const roadpose_plane_box_t *box, uint32_t *random,
                        int32_t *best_q16, int32_t *best_score) {
    const uint32_t drawn = roadpose_lcg_below(random, cloud->pairs); /* pairs >= 1; dx is never 0 */
    const int32_t slope_q16 = (int32_t)((int64_t)cloud->dy[drawn] * 65536 / cloud->dx[drawn]);
    if (slope_q16 > box->slope_max_q16 || slope_q16 < -box->slope_max_q16) {
        return;
    }
    int32_t score = 0; /* <= 1024 pairs * 3 */
    for (uint16_t k = 0; k < cloud->pairs; k++) {
        const int64_t error = slope_error_q16(cloud, k, slope_q16);
        /* a close hit counts more, so that the middle of a crowd wins over its edge */
        score += (error <= SLOPE_TOLERANCE_Q16) ? 1 : 0;
        score += (error <= SLOPE_TOLERANCE_Q16 / 3) ? 2 : 0;
    }
    if (score > *best_score) {
        *best_score = score;
        *best_q16 = slope_q16;
    }
}

uint16_t roadpose_slope_fit(roadpose_cloud_t *cloud, int32_t *slope_q16) {
    int64_t xx = 0; /* <= 2^10 pairs * 2^22 */
    int64_t xy = 0;
    for (uint16_t k = 0; k < cloud->pairs; k++) {
        if (slope_error_q16(cloud, k, *slope_q16) <= SLOPE_TOLERANCE_Q16) {
            xx += (int64_t)cloud->dx[k] * cloud->dx[k];
            xy += (int64_t)cloud->dx[k] * cloud->dy[k];
        }
    }
    if (xx > 0) {
        *slope_q16 = roadpose_clamp32(xy * 65536 / xx); /* < 2^48 */
    }
    uint16_t agree = 0;
    for (uint16_t k = 0; k < cloud->pairs; k++) {
        if (slope_error_q16(cloud, k, *slope_q16) <= SLOPE_TOLERANCE_Q16) {
            agree++;
        } else {
            cloud->level_q8[k] = 0;
        }
    }
    return agree;
}

/* Intercept of pair k, twice, grid rows in Q16: the line through its middle. |y_sum| <= 2^12, |s x_sum| <= 2^32. */
static int64_t twice_intercept_q16(const roadpose_cloud_t *cloud, uint16_t k, int32_t slope_q16) {
    return (int64_t)cloud->y_sum[k] * 65536 - (int64_t)slope_q16 * cloud->x_sum[k];
}

/* Disparity, Q8, by which pair k misses the line. b < 2^31, t < 2^34: cut t to Q8 rows first. */
static int64_t level_error_q8(const roadpose_cloud_t *cloud, uint16_t k, int32_t slope_q16,
                              const roadpose_plane_t *plane) {
    const int64_t t_q9 = roadpose_floor_shift(twice_intercept_q16(cloud, k, slope_q16), 8); /* twice, so Q9 rows */
    const int64_t on_line_q8 = roadpose_floor_shift(plane->b_q24 * t_q9 + plane->c_q24 * 512, 25);
    return cloud->level_q8[k] - on_line_q8;
}

static bool line_through(const roadpose_cloud_t *cloud, int32_t slope_q16, uint16_t first, uint16_t second,
                         roadpose_plane_t *plane) {
    const int64_t t1 = twice_intercept_q16(cloud, first, slope_q16);
    const int64_t t2 = twice_intercept_q16(cloud, second, slope_q16);
    if (roadpose_abs(t2 - t1) < (int64_t)2 * INTERCEPTS_APART_PX * 65536 / ROADPOSE_ROW_STEP) {
        return false;
    }
    /* levels Q8 over twice rows Q16: * 2^(24 - 8 + 16 + 1) */
    const int64_t levels = (int64_t)cloud->level_q8[second] - cloud->level_q8[first];
    const int64_t b = roadpose_clamp(roadpose_ratio(levels, t2 - t1, 33), INT32_MIN, INT32_MAX);
    plane->b_q24 = (int32_t)b;
    plane->c_q24 = (int64_t)cloud->level_q8[first] * 65536 - roadpose_floor_shift(b * roadpose_floor_shift(t1, 8), 9);
    return true;
}

/* d = b (y - s x) + c, so a = -b s. */
static void add_roll(roadpose_plane_t *plane, int32_t slope_q16) {
    plane->a_q24 = roadpose_clamp32(-roadpose_floor_shift((int64_t)plane->b_q24 * slope_q16, 16));
}

void roadpose_intercept_try(const roadpose_cloud_t *cloud, const roadpose_plane_box_t *box, int32_t slope_q16,
                            uint32_t *random, roadpose_plane_t *best, int32_t *best_score) {
    const uint16_t first = (uint16_t)roadpose_lcg_below(random, cloud->pairs);
    const uint16_t second = (uint16_t)roadpose_lcg_below(random, cloud->pairs);
    roadpose_plane_t plane = {0, 0, 0};
    if (cloud->level_q8[first] == 0u || cloud->level_q8[second] == 0u ||
        !line_through(cloud, slope_q16, first, second, &plane) || !roadpose_profile_in_box(&plane, box)) {
        return;
    }
    int32_t score = 0;
    for (uint16_t k = 0; k < cloud->pairs; k++) {
        const int64_t error = roadpose_abs(level_error_q8(cloud, k, slope_q16, &plane));
        if (cloud->level_q8[k] != 0u && error <= LEVEL_TOLERANCE_Q8) {
            score += (error <= LEVEL_TOLERANCE_Q8 / 3) ? 3 : 1;
        }
    }
    if (score > *best_score) {
        *best_score = score;
        add_roll(&plane, slope_q16);
        *best = plane;
    }
}

uint16_t roadpose_intercept_fit(const roadpose_cloud_t *cloud, int32_t slope_q16, roadpose_plane_t *plane) {
    int64_t n = 0;
    int64_t t_sum = 0; /* twice rows Q8: 2^10 pairs * 2^26 */
    int64_t r_sum = 0;
    int64_t tt = 0; /* in twice rows Q4: 2^10 * 2^44 */
    int64_t tr = 0;
    for (uint16_t k = 0; k < cloud->pairs; k++) {
        const int64_t r = level_error_q8(cloud, k, slope_q16, plane);
        if (cloud->level_q8[k] != 0u && roadpose_abs(r) <= LEVEL_TOLERANCE_Q8) {
            const int64_t t = roadpose_floor_shift(twice_intercept_q16(cloud, k, slope_q16), 12); /* Q4, twice: Q5 */
            n++;
            t_sum += t;
            r_sum += r;
            tt += t * t;
            tr += t * r;
        }
    }
    const int64_t spread = n * tt - t_sum * t_sum; /* < 2^10 * 2^54 / 4 */
    if (n < 2 || spread <= 0 || spread >= (INT64_C(1) << 62)) {
        return 0;
    }
    /* slope: Q8 per Q5 rows, to Q24 per row: 2^(24 - 8 + 5) */
    const int64_t b = roadpose_clamp(roadpose_ratio(n * tr - t_sum * r_sum, spread, 21), -(1 << 30), 1 << 30);
    plane->c_q24 += (r_sum * 65536 - roadpose_floor_shift(b * t_sum, 5)) / n;
    plane->b_q24 = roadpose_clamp32(plane->b_q24 + b);
    add_roll(plane, slope_q16);
    return (uint16_t)n;
}
