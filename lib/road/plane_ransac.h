/* Method 2, stage 2 (paper, section 3.1.2): RANSAC for the slope, which is roll, and a robust line through the
 * intercepts over disparity, which is pitch and height. */
#ifndef ROADPOSE_PLANE_RANSAC_H
#define ROADPOSE_PLANE_RANSAC_H

#include "road/ground_plane.h"
#include "roadpose/state.h"

#define ROADPOSE_SLOPE_HYPOTHESES 64
#define ROADPOSE_INTERCEPT_HYPOTHESES 64

/* Slope s of the lines of constant disparity, grid rows per grid column: one hypothesis, of a random pair.
 * Cost: all pairs once. */
void roadpose_slope_try(const roadpose_cloud_t *cloud, const roadpose_plane_box_t *box, uint32_t *random,
                        int32_t *best_q16, int32_t *best_score);

/* Least squares of the slope on the pairs that agree with *slope_q16; then keeps only the pairs that agree with the
 * result, with their intercepts. Returns how many that are. Cost: all pairs twice. */
uint16_t roadpose_slope_fit(roadpose_cloud_t *cloud, const roadpose_plane_box_t *box, int32_t *slope_q16);

/* The plane d = b (y - s x) + c through the intercepts t = y - s x of two random pairs: one hypothesis.
 * Cost: all kept pairs once. */
void roadpose_intercept_try(const roadpose_cloud_t *cloud, const roadpose_plane_box_t *box, int32_t slope_q16,
                            uint32_t *random, roadpose_plane_t *best, int32_t *best_score);

/* Least squares of b and c on the pairs that agree with *plane. Returns how many do; below 2 the plane is unchanged.
 * Cost: all pairs once. */
uint16_t roadpose_intercept_fit(const roadpose_cloud_t *cloud, int32_t slope_q16, roadpose_plane_t *plane);

#endif
