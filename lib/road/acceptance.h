/* May the plane be trusted? Turns the last look at the road points into support figures and a status. */
#ifndef ROADPOSE_ACCEPTANCE_H
#define ROADPOSE_ACCEPTANCE_H

#include "roadpose/state.h"

/* Fills *pose: support figures always; the pose fields and `observed` only where the status is ok.
 * roll_observed: the plane's roll was measured, not assumed. */
void roadpose_accept(roadpose_pose_t *pose, const roadpose_plane_t *plane, const roadpose_moments_t *moments,
                     const roadpose_grid_t *grid, const roadpose_settings_t *settings, bool roll_observed);

/* Ends a frame without a pose: keeps the sample counts, clears the rest. */
void roadpose_refuse(roadpose_pose_t *pose, roadpose_status_t status);

#endif
