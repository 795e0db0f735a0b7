/* Method 2, stage 1 (paper, section 3.1.2): pairs of free-map points of one disparity level. Each pair is a line in
 * the image, a slope and an intercept. */
#ifndef ROADPOSE_SLOPE_CLOUD_H
#define ROADPOSE_SLOPE_CLOUD_H

#include "roadpose/state.h"

/* Tries of a frame to find ROADPOSE_MAX_PAIRS pairs. */
#define ROADPOSE_PAIR_TRIES (4 * ROADPOSE_MAX_PAIRS)

void roadpose_cloud_clear(roadpose_cloud_t *cloud);

/* Sorting by disparity, in three steps: count the points first...last - 1 (of which *thinning chooses some),
 * then turn counts into places once, then place the same points. *thinning begins anew
 * for both passes. */
void roadpose_cloud_count(roadpose_cloud_t *cloud, const roadpose_points_t *points, uint16_t first, uint16_t last,
                          roadpose_thinning_t *thinning);
void roadpose_cloud_places(roadpose_cloud_t *cloud);
void roadpose_cloud_place(roadpose_cloud_t *cloud, const roadpose_points_t *points, uint16_t first, uint16_t last,
                          roadpose_thinning_t *thinning);

/* Draws two points of nearly the same disparity; keeps them as a pair where they lie far enough apart sideways. */
void roadpose_cloud_try_pair(roadpose_cloud_t *cloud, const roadpose_points_t *points, const roadpose_grid_t *grid,
                             uint32_t *random);

#endif
