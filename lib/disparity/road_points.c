#include "disparity/road_points.h"

void roadpose_points_clear(roadpose_points_t *points) {
    points->count = 0;
    points->row_start[0] = 0;
}

void roadpose_points_add_row(roadpose_points_t *points, const uint16_t *row_q8, int16_t columns, int16_t row,
                             uint32_t total, uint32_t *thinning) {
    const uint32_t keep = (total < ROADPOSE_MAX_POINTS) ? total : ROADPOSE_MAX_POINTS;
    uint16_t n = points->count;
    for (int16_t i = 0; i < columns; i++) {
        /* n stays below the limit by itself unless the buffer changed between the two passes over it */
        if (row_q8[i] != 0u && roadpose_thin(thinning, keep, total) && n < ROADPOSE_MAX_POINTS) {
            points->column[n] = (uint16_t)i;
            points->disparity_q8[n] = row_q8[i];
            n++;
        }
    }
    points->count = n;
    points->row_start[row + 1] = n;
}

int16_t roadpose_points_row(const roadpose_points_t *points, int16_t rows, uint16_t index) {
    int16_t low = 0;
    int16_t high = rows; /* row_start[low] <= index < row_start[high] */
    while (high - low > 1) {
        const int16_t middle = (int16_t)((low + high) / 2);
        if (points->row_start[middle] <= index) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}
