/* Tracks as a flow field in angles of the pin-hole model, and the flow that a rotation of the camera makes. */
#ifndef ROADPOSE_HEADING_FLOW_FIELD_H
#define ROADPOSE_HEADING_FLOW_FIELD_H

#include "fixed_point/fixed_point.h"
#include "roadpose/heading.h"

/* Bounds of every flow that is kept: |m| <= 2 (q16: 2^17), |d| <= 1/2 in each component (q22: 2^21). */
#define ROADPOSE_FLOW_REACH 2

/* Prepares the lens. Focal length 50...4000 px: k = 65536000 / f_millipx in q20, 2^24...2^30.4. */
void roadpose_lens_prepare(roadpose_lens_t *lens, const roadpose_rig_t *rig);

/* Fills instance->flow from the tracks, the moving ones first, and counts them and the dropped ones. */
void roadpose_flow_take(roadpose_heading_t *instance, const roadpose_track_t *tracks, size_t count,
                        roadpose_yaw_t *yaw);

/* Length of (x, y) to 7 %, never too short by more than 3 %: max(a, 7/8 a + 1/2 b) for a >= b. |x|, |y| < 2^29. */
static inline int32_t roadpose_length(int32_t x, int32_t y) {
    const int32_t ax = (x < 0) ? -x : x;
    const int32_t ay = (y < 0) ? -y : y;
    const int32_t a = (ax > ay) ? ax : ay;
    const int32_t b = (ax > ay) ? ay : ax;
    const int32_t c = a - (a >> 3) + (b >> 1);
    return (c > a) ? c : a;
}

static inline int32_t roadpose_longer_side(int32_t x, int32_t y) {
    const int32_t ax = (x < 0) ? -x : x;
    const int32_t ay = (y < 0) ? -y : y;
    return (ax > ay) ? ax : ay;
}

/* Products of a place (x, y), |x|, |y| <= 2, that the flow of a rotation (x, y, z camera axes) is made of:
 *   du = xy wx - (1 + x^2) wy + y wz      dv = (1 + y^2) wx - xy wy - x wz
 * q26: |1 + x^2| <= 5, below 2^28.4. */
typedef struct {
    int32_t xy_q26;
    int32_t xx_q26; /* 1 + x^2 */
    int32_t yy_q26;
    int32_t x_q26;
    int32_t y_q26;
} roadpose_turn_terms_t;

static inline roadpose_turn_terms_t roadpose_turn_terms(int32_t x_q16, int32_t y_q16) {
    const int32_t x_q13 = roadpose_floor_shift32(x_q16, 3);
    const int32_t y_q13 = roadpose_floor_shift32(y_q16, 3);
    return (roadpose_turn_terms_t){x_q13 * y_q13, (INT32_C(1) << 26) + x_q13 * x_q13, (INT32_C(1) << 26) + y_q13 * y_q13,
                                   x_q16 * 1024, y_q16 * 1024};
}

/* The flow of a rotation, turn in q28 rad, |turn| <= 1/2: three products below 2^55.4 each; q54 to q22. */
static inline void roadpose_turn_flow(const roadpose_turn_terms_t *t, const int32_t *turn_q28, int32_t *flow_q22) {
    flow_q22[0] = (int32_t)roadpose_floor_shift((int64_t)t->xy_q26 * turn_q28[0] - (int64_t)t->xx_q26 * turn_q28[1] +
                                                    (int64_t)t->y_q26 * turn_q28[2], 32);
    flow_q22[1] = (int32_t)roadpose_floor_shift((int64_t)t->yy_q26 * turn_q28[0] - (int64_t)t->xy_q26 * turn_q28[1] -
                                                    (int64_t)t->x_q26 * turn_q28[2], 32);
}

#endif
