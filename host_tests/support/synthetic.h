/* Frames whose truth is exact: disparity planes computed in double precision. */
#ifndef ROADPOSE_TEST_SYNTHETIC_H
#define ROADPOSE_TEST_SYNTHETIC_H

#include "roadpose/roadpose.h"

typedef struct {
    double pitch_deg;
    double roll_deg;
    double height_m;
} true_pose_t;

/* d(u, v) = a (u - cu) + b (v - cv) + c, pixels: the road in disparity space. */
typedef struct {
    double a, b, c;
} true_plane_t;

true_plane_t true_plane_of(const roadpose_rig_t *rig, true_pose_t pose);
true_pose_t true_pose_of(const roadpose_rig_t *rig, true_plane_t plane);
double true_disparity_at(const roadpose_rig_t *rig, true_plane_t plane, double u, double v);

/* An endless road and nothing else: U16 samples with 8 fraction bits in this machine's byte order, rounded to the
 * nearest; 0 (no match) above the horizon and from disparity_limit_px on. */
void render_road(const roadpose_rig_t *rig, true_pose_t pose, int disparity_limit_px, uint16_t *samples);

/* An upright wall across columns [from, to): one disparity, from the road up to rows_high rows above it. */
void render_wall(const roadpose_rig_t *rig, true_pose_t pose, double disparity_px, int from, int to, int rows_high,
                 uint16_t *samples);

roadpose_rig_t rig_640x480(void); /* the fixtures' rig: f = 500 px, B = 0.30 m */
roadpose_disparity_format_t format_u16_q8(void);
roadpose_frame_t frame_of(const roadpose_rig_t *rig, const void *samples); /* rows without a gap */

#endif
