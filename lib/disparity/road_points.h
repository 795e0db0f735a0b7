/* Samples of the free map, thinned evenly to what the memory holds. */
#ifndef ROADPOSE_ROAD_POINTS_H
#define ROADPOSE_ROAD_POINTS_H

#include "roadpose/state.h"

/* Begins anew. keep <= total < 2^24. */
static inline void roadpose_thinning_begin(roadpose_thinning_t *thinning, uint32_t keep, uint32_t total) {
    thinning->keep = keep;
    thinning->total = total;
    thinning->error = 0;
}

/* Is the next candidate chosen? (Bresenham's error term.) */
static inline bool roadpose_thin(roadpose_thinning_t *thinning) {
    thinning->error += thinning->keep;
    if (thinning->error < thinning->total) {
        return false;
    }
    thinning->error -= thinning->total;
    return true;
}

/* points->column[i]: the grid column (below 1024) and, above it, the weight of the corridor (0...2). */
#define ROADPOSE_POINT_COLUMN 0x03FFu
#define ROADPOSE_POINT_WEIGHT_SHIFT 14u

static inline int32_t roadpose_point_column(uint16_t entry) {
    return (int32_t)(entry & ROADPOSE_POINT_COLUMN);
}

static inline uint32_t roadpose_point_weight(uint16_t entry) {
    return (uint32_t)entry >> ROADPOSE_POINT_WEIGHT_SHIFT;
}

void roadpose_points_clear(roadpose_points_t *points);

/* Writes a sample to place n, where there is one, and returns the next place; rows come in rising order. */
static inline uint32_t roadpose_points_put(roadpose_points_t *points, uint32_t n, int16_t column, uint32_t disparity_q8) {
    if (n == ROADPOSE_MAX_POINTS) {
        return n;
    }
    points->column[n] = (uint16_t)column;
    points->disparity_q8[n] = (uint16_t)disparity_q8;
    return n + 1u;
}

/* Ends a row: the points are those before place n. */
static inline void roadpose_points_end_row(roadpose_points_t *points, uint32_t n, int16_t row) {
    points->count = (uint16_t)n;
    points->row_start[row + 1] = (uint16_t)n;
}

/* Grid row of a point. index < points->count. 11 rounds of bisection over 1024 rows. */
int16_t roadpose_points_row(const roadpose_points_t *points, int16_t rows, uint16_t index);

#endif
