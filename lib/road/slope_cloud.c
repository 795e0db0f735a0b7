#include "road/slope_cloud.h"

#include <string.h>

#include "disparity/road_points.h"
#include "fixed_point/fixed_point.h"

/* Closer points give no slope worth having. */
#define SIDEWAYS_MIN_PX 32
/* "The same level": at most half a pixel apart. */
#define LEVEL_WIDTH_Q8 128
/* A partner is drawn from the neighbouring sort levels; the fewer points, the further around. Eighths of a pixel. */
#define REACH_MAX 4
#define PARTNERS_ENOUGH 16u

void roadpose_cloud_clear(roadpose_cloud_t *cloud) {
    memset(cloud->bucket, 0, sizeof cloud->bucket);
    cloud->used = 0;
    cloud->pairs = 0;
}

static unsigned sort_level(uint16_t disparity_q8) {
    return (unsigned)disparity_q8 >> 5; /* disparity < ROADPOSE_MAX_DISPARITY * 256, so below ROADPOSE_SORT_LEVELS */
}

void roadpose_cloud_count(roadpose_cloud_t *cloud, const roadpose_points_t *points, uint16_t first, uint16_t last,
                          roadpose_thinning_t *thinning) {
    roadpose_thinning_t local = *thinning; /* stays in registers, as does what is used */
    uint16_t used = cloud->used;
    for (uint16_t i = first; i < last; i++) {
        if (roadpose_thin(&local)) {
            cloud->bucket[sort_level(points->disparity_q8[i]) + 1u]++;
            used++;
        }
    }
    cloud->used = used;
    *thinning = local;
}

static uint8_t octave_of(unsigned sort_level) {
    uint8_t octave = 0;
    while ((sort_level >> octave) > 1u) {
        octave++;
    }
    return octave;
}

/* Octaves of the sort levels that hold points: level 2^k...2^(k+1) - 1 is octave k. Levels 0 and 1 share the first. */
static void find_octaves(roadpose_cloud_t *cloud) {
    unsigned first = 0;
    unsigned last = ROADPOSE_SORT_LEVELS - 1u;
    while (first < last && cloud->bucket[first + 1u] == 0u) {
        first++;
    }
    while (last > first && cloud->bucket[last + 1u] == 0u) {
        last--;
    }
    cloud->first_octave = octave_of(first);
    cloud->last_octave = octave_of(last);
}

void roadpose_cloud_places(roadpose_cloud_t *cloud) {
    find_octaves(cloud);
    for (unsigned level = 0; level < ROADPOSE_SORT_LEVELS; level++) {
        cloud->bucket[level + 1u] = (uint16_t)(cloud->bucket[level + 1u] + cloud->bucket[level]);
    }
}

void roadpose_cloud_place(roadpose_cloud_t *cloud, const roadpose_points_t *points, uint16_t first, uint16_t last,
                          roadpose_thinning_t *thinning) {
    roadpose_thinning_t local = *thinning;
    for (uint16_t i = first; i < last; i++) {
        if (roadpose_thin(&local)) {
            uint16_t *place = &cloud->bucket[sort_level(points->disparity_q8[i])];
            cloud->order[*place] = i;
            *place = (uint16_t)(*place + 1u);
        }
    }
    *thinning = local;
}

static void keep_pair(roadpose_cloud_t *cloud, const roadpose_points_t *points, const roadpose_grid_t *grid,
                      uint16_t first, uint16_t second) {
    const int32_t x1 = roadpose_point_column(points->column[first]) - grid->column_0;
    const int32_t x2 = roadpose_point_column(points->column[second]) - grid->column_0;
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

/* First place of a sort level in cloud->order; placing has moved bucket[level] to the end of its level. */
static uint32_t level_start(const roadpose_cloud_t *cloud, uint32_t level) {
    return (level == 0u) ? 0u : cloud->bucket[level - 1u];
}

/* Every doubling of the distance counts the same: drawn point by point, the few metres before the car, which fill most
 * of the image, would decide alone, and a speed bump there would pass for the road. */
static uint32_t draw_sort_level(const roadpose_cloud_t *cloud, uint32_t *random) {
    const uint32_t octaves = (uint32_t)cloud->last_octave - cloud->first_octave + 1u;
    const uint32_t size = UINT32_C(1) << (cloud->first_octave + roadpose_lcg_below(random, octaves));
    return size + roadpose_lcg_below(random, size); /* < 2 * ROADPOSE_SORT_LEVELS */
}

/* Draws a point about as near in disparity as the first, wherever it stands in the image. */
static uint16_t draw_partner(const roadpose_cloud_t *cloud, uint32_t level, uint32_t *random) {
    uint32_t start = level_start(cloud, level);
    uint32_t end = cloud->bucket[level];
    for (uint32_t reach = 1; reach <= REACH_MAX && end - start < PARTNERS_ENOUGH; reach++) {
        start = level_start(cloud, (level > reach) ? level - reach : 0u);
        end = cloud->bucket[(level + reach < ROADPOSE_SORT_LEVELS) ? level + reach : ROADPOSE_SORT_LEVELS - 1u];
    }
    return cloud->order[start + roadpose_lcg_below(random, end - start)];
}

void roadpose_cloud_try_pair(roadpose_cloud_t *cloud, const roadpose_points_t *points, const roadpose_grid_t *grid,
                             uint32_t *random) {
    const uint32_t level = draw_sort_level(cloud, random);
    if (level >= ROADPOSE_SORT_LEVELS || cloud->pairs >= ROADPOSE_MAX_PAIRS) {
        return; /* beyond the levels is as empty as an empty level: larger limits draw the same pairs */
    }
    const uint32_t start = level_start(cloud, level);
    const uint32_t count = cloud->bucket[level] - start;
    if (count == 0u) {
        return;
    }
    const uint16_t first = cloud->order[start + roadpose_lcg_below(random, count)];
    const uint16_t second = draw_partner(cloud, level, random);
    const int64_t apart = roadpose_abs(points->disparity_q8[first] - points->disparity_q8[second]);
    const int64_t sideways =
        roadpose_abs(roadpose_point_column(points->column[first]) - roadpose_point_column(points->column[second]));
    if (apart <= LEVEL_WIDTH_Q8 && sideways * ROADPOSE_COLUMN_STEP >= SIDEWAYS_MIN_PX) {
        keep_pair(cloud, points, grid, first, second);
    }
}
