/* Rows of Q8 disparities (0 = none) as the library reads them, and points made of them. */
#ifndef ROWS_H
#define ROWS_H

#include "disparity/decoder.h"
#include "disparity/road_points.h"

static inline roadpose_row_t row_of_q8(const uint16_t *row_q8) {
    const roadpose_row_t samples = {(const uint8_t *)row_q8, 2, false, 1, UINT16_MAX - 1, 256, 0};
    return samples;
}

/* What a free map that is free everywhere would keep of the row. */
static inline void add_points(roadpose_points_t *points, const uint16_t *row_q8, int16_t columns, int16_t row,
                              roadpose_thinning_t *thinning) {
    uint32_t n = points->count;
    for (int16_t i = 0; i < columns; i++)
        if (row_q8[i] != 0 && roadpose_thin(thinning)) n = roadpose_points_put(points, n, i, row_q8[i]);
    roadpose_points_end_row(points, n, row);
}

#endif
