/* roadpose: what comes out of a frame. */
#ifndef ROADPOSE_POSE_H
#define ROADPOSE_POSE_H

#include <stdint.h>

/* May I trust this frame, and if not, why was it refused? */
typedef enum {
    ROADPOSE_STATUS_OK = 0,
    ROADPOSE_STATUS_NO_DISPARITY = 1,   /* too few samples carry a disparity */
    ROADPOSE_STATUS_NO_ROAD = 2,        /* nothing in the free map is like a road within the mounting limits */
    ROADPOSE_STATUS_LITTLE_SUPPORT = 3, /* a road, but too few points on it, or within too few rows (spread under 10 px) */
    ROADPOSE_STATUS_SHORT_RANGE = 4,    /* a plane that does not reach far enough ahead, or not twice as far as it begins:
                                           a bonnet, a gap behind a lorry */
    ROADPOSE_STATUS_POOR_FIT = 5,       /* too many points of the corridor disagree with the plane, or its inner half does */
    ROADPOSE_STATUS_OUTSIDE_LIMITS = 6  /* the plane's pitch, roll or height is outside the mounting limits */
} roadpose_status_t;
#define ROADPOSE_STATUS_COUNT 7

/* Bits of roadpose_pose_t.observed. Pitch and height are observed in every accepted frame. Roll is not by Method 1
 * without refinement, nor where the road points spread less than 20 px (root mean square) sideways; pitch and height then
 * rest on a roll of zero (Method 1) or on Method 2's rough slope. */
#define ROADPOSE_OBSERVED_PITCH 1u
#define ROADPOSE_OBSERVED_ROLL 2u
#define ROADPOSE_OBSERVED_HEIGHT 4u

/* Pose of the rig over the road in one frame. Where status is not ROADPOSE_STATUS_OK, observed is 0 and every pose
 * field is 0; the support figures are filled as far as the work came. An axis whose bit is not set in observed was not
 * observed: its field is 0 and means nothing. */
typedef struct {
    uint8_t status;             /* roadpose_status_t */
    uint8_t observed;           /* ROADPOSE_OBSERVED_... */
    int32_t pitch_urad;         /* ISO 8855 theta, + = nose down */
    int32_t roll_urad;          /* ISO 8855 phi, + = right side down */
    int32_t height_um;          /* left camera's optical centre over the road plane */
    int32_t paper_pitch_urad;   /* the paper's pitch tau (it turns roll first, then pitch): same plane, other naming */
    int32_t paper_roll_urad;    /* the paper's roll rho */
    int32_t normal_q30[3];      /* unit normal of the road in camera axes, pointing into the road */
    int32_t plane_u_q24;        /* disparity plane d(u, v) = plane_u (u - cu) + plane_v (v - cv) + plane_0, */
    int32_t plane_v_q24;        /* disparity in pixels, for every pixel of the image: */
    int32_t plane_0_q16;        /* what a function developer needs to tell road from obstacle */
    uint32_t valid_samples;     /* grid samples that carry a disparity */
    uint32_t free_samples;      /* of those, the ones in the free map and the widened corridor */
    uint32_t road_points;       /* points within the final band around the plane, in the corridor */
    uint16_t support_permille;  /* road points among all free points where the plane should be seen, 0...1000 */
    uint16_t residual_millipx;  /* root mean square residual of the road points */
    uint32_t range_near_mm;     /* nearest and farthest road that supported the plane, along the optical axis */
    uint32_t range_far_mm;
} roadpose_pose_t;

#endif
