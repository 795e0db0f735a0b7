/* Yaw and pitch of motion from the direction of travel and the road normal. */
#ifndef ROADPOSE_HEADING_YAW_ANGLE_H
#define ROADPOSE_HEADING_YAW_ANGLE_H

#include <stdbool.h>
#include <stdint.h>

/* True for a vector of length 1 within 1 % in q30. */
bool roadpose_is_unit(const int32_t *normal_q30);

/* Yaw: angle from the forward direction, travel laid into the road, to the optical axis laid into the road; + = axis
 * to the left of it. |focus| <= 1 in each component. */
int32_t roadpose_yaw_angle(const int32_t *focus_q24, const int32_t *normal_q30);

/* Pitch of the optical axis over the road: asin(n_z). */
int32_t roadpose_pitch_of_normal(const int32_t *normal_q30);

/* Angle of the direction of travel below the road plane: pitch of the road minus pitch of motion. */
int32_t roadpose_descent(const int32_t *focus_q24, const int32_t *normal_q30);

#endif
