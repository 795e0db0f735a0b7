/* The disparity plane of the road: limits for candidates, and the pose it stands for. */
#ifndef ROADPOSE_GROUND_PLANE_H
#define ROADPOSE_GROUND_PLANE_H

#include "roadpose/state.h"

/* Outputs of roadpose_plane_pose() that the pose does not carry itself. */
typedef struct {
    int64_t length_q24; /* k = sqrt(a^2 + b^2 + (c / f)^2) = baseline / height */
    int32_t a_q24;      /* plane for a pixel step, about the principal point */
    int32_t b_q24;
    int64_t c_q24;
} roadpose_pixel_plane_t;

/* From the grid to pixels about the principal point. Returns false when a coefficient is out of the proved range. */
bool roadpose_plane_to_pixels(const roadpose_plane_t *plane, const roadpose_grid_t *grid, roadpose_pixel_plane_t *out);

/* Fills the pose fields (angles, height, normal, plane) of *pose. */
void roadpose_plane_pose(const roadpose_pixel_plane_t *plane, const roadpose_grid_t *grid, roadpose_pose_t *pose);

/* True where pitch, roll and height lie within the mounting limits. */
bool roadpose_pose_within_limits(const roadpose_pose_t *pose, const roadpose_settings_t *settings);

/* Prepares the box. Once for each instance: it depends on nothing but rig and settings. */
void roadpose_plane_box(roadpose_plane_box_t *box, const roadpose_grid_t *grid, const roadpose_settings_t *settings);

/* Is d = b y + c, with b and c of *plane, within the box? */
bool roadpose_profile_in_box(const roadpose_plane_t *plane, const roadpose_plane_box_t *box);

#endif
