#include "disparity/road_points.h"

void roadpose_points_clear(roadpose_points_t *points) {
    points->count = 0;
    points->row_start[0] = 0;
}

int16_t roadpose_points_row(const roadpose_points_t *points, int16_t rows, uint16_t index) {
    int16_t row = 0;
    int16_t left = rows; /* row_start[row] <= index < row_start[row + left] */
    while (left > 1) {
        const int16_t half = (int16_t)(left / 2);
        row = (int16_t)(row + ((points->row_start[row + half] <= index) ? half : 0)); /* no branch to guess wrong */
        left = (int16_t)(left - half);
    }
    return row;
}
