#include "heading/yaw_angle.h"

#include "fixed_point/fixed_point.h"

#define ONE_Q24 (INT32_C(1) << 24)

/* Squares in q32 of q16: three of at most 2^34 (|n| <= 2 in q30). */
bool roadpose_is_unit(const int32_t *normal_q30) {
    int64_t sum_q32 = 0;
    for (unsigned i = 0; i < 3; i++) {
        const int64_t n_q16 = roadpose_floor_shift32(normal_q30[i], 14);
        sum_q32 += n_q16 * n_q16;
    }
    const int64_t one_q32 = INT64_C(1) << 32;
    return sum_q32 > one_q32 - one_q32 / 50 && sum_q32 < one_q32 + one_q32 / 50;
}

/* t . n for t = (focus, 1): three products of at most 2^24 * 1.01 * 2^30. */
static int64_t along_normal_q24(const int32_t *t, const int32_t *n) {
    const int64_t sum_q54 = (int64_t)t[0] * n[0] + (int64_t)t[1] * n[1] + (int64_t)ONE_Q24 * n[2];
    return roadpose_floor_shift(sum_q54, 30);
}

/* forward = t - (t . n) n, left = up x forward = -n x t, axis = (0, 0, 1): their common length cancels.
 * Both arguments below 4 * 2^24 = 2^26; times 8 < 2^29. */
int32_t roadpose_yaw_angle(const int32_t *focus_q24, const int32_t *normal_q30) {
    const int64_t left_q24 =
        roadpose_floor_shift((int64_t)normal_q30[1] * focus_q24[0] - (int64_t)normal_q30[0] * focus_q24[1], 30);
    const int64_t along_q24 = along_normal_q24(focus_q24, normal_q30);
    const int64_t forward_q24 = ONE_Q24 - roadpose_floor_shift(along_q24 * normal_q30[2], 30);
    return roadpose_arctangent((int32_t)(left_q24 * 8), (int32_t)(forward_q24 * 8));
}

/* asin(a / c) = atan(a / sqrt(c^2 - a^2)); squares in 64 bits: c^2 <= 3 * 2^48. */
static int32_t arcsine(int64_t a_q24, int64_t square_q48) {
    const int64_t rest_q48 = square_q48 - a_q24 * a_q24;
    const int64_t root_q24 = (rest_q48 > 0) ? (int64_t)roadpose_sqrt((uint64_t)rest_q48) : 0;
    return roadpose_arctangent((int32_t)(a_q24 * 8), (int32_t)(root_q24 * 8));
}

int32_t roadpose_pitch_of_normal(const int32_t *normal_q30) {
    return arcsine(roadpose_floor_shift32(normal_q30[2], 6), (int64_t)ONE_Q24 * ONE_Q24);
}

int32_t roadpose_descent(const int32_t *focus_q24, const int32_t *normal_q30) {
    const int64_t square_q48 = (int64_t)ONE_Q24 * ONE_Q24 + (int64_t)focus_q24[0] * focus_q24[0] +
                               (int64_t)focus_q24[1] * focus_q24[1];
    return arcsine(along_normal_q24(focus_q24, normal_q30), square_q48);
}
