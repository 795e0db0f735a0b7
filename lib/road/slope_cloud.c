#include "road/slope_cloud.h"

#include <string.h>

#include "disparity/road_points.h"
#include "fixed_point/fixed_point.h"

/* Closer points give no slope worth having. */
#define SIDEWAYS_MIN_PX 32
/* "The same level": at most half a pixel apart. */
#define LEVEL_WIDTH_Q8 128
/* How far apart in the order of disparity two points of a pair may stand: few points reach further. */
#define REACH_SHARE 256
#define REACH_MIN 8
#define REACH_MAX 64

void roadpose_cloud_clear(roadpose_cloud_t *cloud) {
    memset(cloud->bucket, 0, sizeof cloud->bucket);
    cloud->used = 0;
    cloud->pairs = 0;
}

static unsigned sort_level(uint16_t disparity_q8) {
    return (unsigned)disparity_q8 >> 5; /* disparity < ROADPOSE_MAX_DISPARITY * 256, so below ROADPOSE_SORT_LEVELS */
}

void roadpose_cloud_count(roadpose_cloud_t *cloud, const roadpose_points_t *points, uint16_t first, uint16_t last,
                          uint8_t percent, uint32_t *thinning) {
    for (uint16_t i = first; i < last; i++) {
        if (roadpose_thin(thinning, percent, 100)) {
            cloud->bucket[sort_level(points->disparity_q8[i]) + 1u]++;
            cloud->used++;
        }
    }
}

void roadpose_cloud_places(roadpose_cloud_t *cloud) {
    for (unsigned level = 0; level < ROADPOSE_SORT_LEVELS; level++) {
        cloud->bucket[level + 1u] = (uint16_t)(cloud->bucket[level + 1u] + cloud->bucket[level]);
    }
}

void roadpose_cloud_place(roadpose_cloud_t *cloud, const roadpose_points_t *points, uint16_t first, uint16_t last,
                          uint8_t percent, uint32_t *thinning) {
    for (uint16_t i = first; i < last; i++) {
        if (roadpose_thin(thinning, percent, 100)) {
            uint16_t *place = &cloud->bucket[sort_level(points->disparity_q8[i])];
            cloud->order[*place] = i;
            *place = (uint16_t)(*place + 1u);
        }
    }
}

static void keep_pair(roadpose_cloud_t *cloud, const roadpose_points_t *points, const roadpose_grid_t *grid,
                      uint16_t first, uint16_t second) {
    const int32_t x1 = points->column[first] - grid->column_0;
    const int32_t x2 = points->column[second] - grid->column_0;
    const int32_t y1 = roadpose_points_row(points, grid->rows, first) - grid->row_0;
    const int32_t y2 = roadpose_points_row(points, grid->rows, second) - grid->row_0;
    const uint16_t k = cloud->pairs;
    cloud->dx[k] = (int16_t)(x2 - x1); /* all within +-2048 */
    cloud->dy[k] = (int16_t)(y2 - y1);
    cloud->x_sum[k] = (int16_t)(x1 + x2);
    cloud->y_sum[k] = (int16_t)(y1 + y2);
    cloud->level_q8[k] = (uint16_t)(((uint32_t)points->disparity_q8[first] + points->disparity_q8[second]) / 2u);
    cloud->pairs = (uint16_t)(k + 1u);
}

void roadpose_cloud_try_pair(roadpose_cloud_t *cloud, const roadpose_points_t *points, const roadpose_grid_t *grid,
                             uint32_t *random) {
    if (cloud->used < 2u || cloud->pairs >= ROADPOSE_MAX_PAIRS) {
        return;
    }
    const uint32_t reach = (uint32_t)roadpose_clamp(cloud->used / REACH_SHARE, REACH_MIN, REACH_MAX);
    const uint32_t i = roadpose_lcg_below(random, cloud->used);
    const uint32_t j = i + 1u + roadpose_lcg_below(random, reach);
    if (j >= cloud->used) {
        return;
    }
    const uint16_t first = cloud->order[i];
    const uint16_t second = cloud->order[j];
    const int64_t apart = roadpose_abs(points->disparity_q8[first] - points->disparity_q8[second]);
    const int64_t sideways = roadpose_abs(points->column[first] - points->column[second]);
    if (apart <= LEVEL_WIDTH_Q8 && sideways * ROADPOSE_COLUMN_STEP >= SIDEWAYS_MIN_PX) {
        keep_pair(cloud, points, grid, first, second);
    }
}
