/* Samples of the free map, thinned evenly to what the memory holds. */
#ifndef ROADPOSE_ROAD_POINTS_H
#define ROADPOSE_ROAD_POINTS_H

#include "roadpose/state.h"

/* Spreads `keep` choices evenly over `total` candidates (Bresenham's error term). keep <= total < 2^24. */
static inline bool roadpose_thin(uint32_t *error, uint32_t keep, uint32_t total) {
    *error += keep;
    if (*error < total) {
        return false;
    }
    *error -= total;
    return true;
}

/* points->column[i]: the grid column (below 1024) and, above it, the weight of the corridor (0...2). */
#define ROADPOSE_POINT_COLUMN 0x03FFu
#define ROADPOSE_POINT_WEIGHT_SHIFT 14u

static inline int32_t roadpose_point_column(uint16_t entry) {
    return (int32_t)(entry & ROADPOSE_POINT_COLUMN);
}

static inline int32_t roadpose_point_weight(uint16_t entry) {
    return (int32_t)(entry >> ROADPOSE_POINT_WEIGHT_SHIFT);
}

void roadpose_points_clear(roadpose_points_t *points);

/* Appends the free samples of row `row`; rows come in rising order. total: free samples of the whole frame. */
void roadpose_points_add_row(roadpose_points_t *points, const uint16_t *row_q8, int16_t columns, int16_t row,
                             uint32_t total, uint32_t *thinning);

/* Grid row of a point. index < points->count. At most 10 rounds of bisection over `rows` rows. */
int16_t roadpose_points_row(const roadpose_points_t *points, int16_t rows, uint16_t index);

#endif
