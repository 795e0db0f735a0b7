/* One frame's work, between the arguments and the result. */
#ifndef ROADPOSE_HEADING_HEADING_H
#define ROADPOSE_HEADING_HEADING_H

#include "roadpose/heading.h"

/* Everything about one frame pair: motion is checked, normal_q30 may be NULL. Fills *yaw, status included. */
void roadpose_heading_estimate(roadpose_heading_t *instance, const roadpose_motion_t *motion, const int32_t *normal_q30,
                               roadpose_yaw_t *yaw);

#endif
