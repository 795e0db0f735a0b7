/* Ranges along the optical axis and disparities: z = f B / d. */
#ifndef ROADPOSE_GROUND_RANGE_H
#define ROADPOSE_GROUND_RANGE_H

#include "roadpose/state.h"

/* Disparity of a point z_mm ahead, Q8, at least 1. z_mm >= 1. */
static inline int32_t roadpose_disparity_q8_at(const roadpose_grid_t *grid, int32_t z_mm) {
    /* f * B <= 4e6 * 2e6 = 8e12 milli-pixel micrometres; * 256 < 2^51. Per mm: 1e6 of them are one pixel. */
    const int64_t q8 = (int64_t)grid->focal_millipx * grid->baseline_um * 256 / ((int64_t)z_mm * 1000000);
    return (int32_t)((q8 < 1) ? 1 : ((q8 > 65535) ? 65535 : q8));
}

/* Distance along the optical axis of a disparity. q8 >= 1. */
static inline uint32_t roadpose_range_mm_at(const roadpose_grid_t *grid, int32_t q8) {
    const int64_t mm = (int64_t)grid->focal_millipx * grid->baseline_um * 256 / ((int64_t)q8 * 1000000);
    return (uint32_t)mm; /* <= 2^51 / 1e6 < 2^32 */
}

/* Smallest disparity that the corridor's range lets count. */
static inline int32_t roadpose_range_min_q8(const roadpose_grid_t *grid, const roadpose_settings_t *settings) {
    return (settings->corridor_range_mm == 0) ? 1 : roadpose_disparity_q8_at(grid, settings->corridor_range_mm);
}

#endif
