/* Method 1 (paper, section 3.1.1): the road profile is a straight line in the v-disparity-free. */
#ifndef ROADPOSE_ROAD_PROFILE_H
#define ROADPOSE_ROAD_PROFILE_H

#include "road/ground_plane.h"
#include "roadpose/state.h"

#define ROADPOSE_PROFILE_HYPOTHESES 128

/* One RANSAC hypothesis: a line through two random counts; *best and *best_score keep the better one.
 * Cost: about 3 * rows + 4 * levels cells. */
void roadpose_profile_try(const roadpose_v_disparity_t *histogram, const roadpose_grid_t *grid,
                          const roadpose_plane_box_t *box, uint32_t *random, roadpose_plane_t *best,
                          int32_t *best_score);

/* Least squares of the line on the counts within `width` levels of it, levels below first_level (beyond the corridor's
 * range) left out. Returns false when they do not tell a line. Cost: (2 * width + 1) * rows cells. */
bool roadpose_profile_fit(const roadpose_v_disparity_t *histogram, const roadpose_grid_t *grid, int32_t first_level,
                          int32_t width, roadpose_plane_t *line);

#endif
