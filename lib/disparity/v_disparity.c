#include "disparity/v_disparity.h"

#include <string.h>

#include "disparity/road_points.h"
#include "disparity/u_disparity.h"

/* Inlined with a constant for swap_bytes: a loop of its own for each byte order. */
static inline uint32_t add_free(roadpose_count_t *count, roadpose_points_t *points, const roadpose_free_map_t *free_map,
                                roadpose_row_t samples, bool swap_bytes, int16_t columns,
                                roadpose_thinning_t *thinning) {
    uint32_t n = points->count;
    for (int16_t i = 0; i < columns; i++) {
        uint32_t disparity_q16;
        if (!roadpose_row_take(&samples, swap_bytes, &disparity_q16)) {
            continue;
        }
        const uint32_t level = disparity_q16 >> 16;
        if (roadpose_cell_is_free(free_map, (unsigned)i, level)) {
            count[level] = (roadpose_count_t)(count[level] + 1u); /* at most once for each grid column */
            if (roadpose_thin(thinning)) { /* there is room unless the buffer changed between the two passes over it */
                n = roadpose_points_put(points, n, i, disparity_q16 >> 8);
            }
        }
    }
    return n;
}

void roadpose_v_disparity_row(roadpose_v_disparity_t *histogram, roadpose_points_t *points,
                              const roadpose_free_map_t *free_map, const roadpose_row_t *samples, int16_t columns,
                              int16_t row, roadpose_thinning_t *thinning) {
    roadpose_count_t *count = histogram->count[row];
    roadpose_thinning_t local = *thinning; /* stays in registers */
    memset(count, 0, sizeof histogram->count[row]);
    const uint32_t n = samples->swap_bytes ? add_free(count, points, free_map, *samples, true, columns, &local)
                                           : add_free(count, points, free_map, *samples, false, columns, &local);
    roadpose_points_end_row(points, n, row);
    *thinning = local;
}
