#include "disparity/v_disparity.h"

#include <string.h>

#include "disparity/u_disparity.h"

void roadpose_v_disparity_row(roadpose_v_disparity_t *histogram, const roadpose_free_map_t *free_map,
                              uint16_t *row_q8, int16_t columns, int16_t row) {
    roadpose_count_t *count = histogram->count[row];
    memset(count, 0, sizeof histogram->count[row]);
    for (int16_t i = 0; i < columns; i++) {
        const unsigned level = (unsigned)row_q8[i] >> 8;
        if (row_q8[i] != 0u && roadpose_cell_is_free(free_map, (unsigned)i, level)) {
            count[level] = (roadpose_count_t)(count[level] + 1u); /* at most once for each grid column */
        } else {
            row_q8[i] = 0;
        }
    }
}
