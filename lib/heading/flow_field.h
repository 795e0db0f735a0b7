/* Tracks as a flow field in angles of the pin-hole model, and the flow that a rotation of the camera makes. */
#ifndef ROADPOSE_HEADING_FLOW_FIELD_H
#define ROADPOSE_HEADING_FLOW_FIELD_H

#include "fixed_point/fixed_point.h"
#include "roadpose/heading.h"

/* Bounds of every flow that is kept: |m| <= 2 (q16: 2^17), |d| <= 1/2 in each component (q22: 2^21). */
#define ROADPOSE_FLOW_REACH_Q24 (INT32_C(2) << 24)
#define ROADPOSE_FLOW_LENGTH_Q24 (INT32_C(1) << 23)

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
    const int32_t c = a - a / 8 + b / 2;
    return (c > a) ? c : a;
}

static inline int32_t roadpose_longer_side(int32_t x, int32_t y) {
    const int32_t ax = (x < 0) ? -x : x;
    const int32_t ay = (y < 0) ? -y : y;
    return (ax > ay) ? ax : ay;
}

/* What a rotation by turn (x, y, z camera axes, q24 rad, |turn| <= 1/2) adds to the flow at (x, y), |x|, |y| <= 2:
 *   du = xy wx - (1 + x^2) wy + y wz      dv = (1 + y^2) wx - xy wy - x wz
 * Products: |1 + x^2| <= 5 (q16 < 2^18.4) times 2^23: below 2^42 each; q40 to q22. */
static inline void roadpose_turn_flow(int32_t x_q16, int32_t y_q16, const int32_t *turn_q24, int32_t *flow_q22) {
    const int64_t x = x_q16;
    const int64_t y = y_q16;
    const int64_t xy = x * y / 65536;
    const int64_t xx = 65536 + ((x * x) >> 16);
    const int64_t yy = 65536 + ((y * y) >> 16);
    flow_q22[0] = (int32_t)((xy * turn_q24[0] - xx * turn_q24[1] + y * turn_q24[2]) / 262144);
    flow_q22[1] = (int32_t)((yy * turn_q24[0] - xy * turn_q24[1] - x * turn_q24[2]) / 262144);
}

#endif
