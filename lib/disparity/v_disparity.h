/* v-disparity of the free map (the paper's v-disparity-free), and the points of the free map. */
#ifndef ROADPOSE_V_DISPARITY_H
#define ROADPOSE_V_DISPARITY_H

#include "disparity/decoder.h"
#include "roadpose/state.h"

/* Replaces grid row `row` of the histogram by the free samples of the row, and adds them to the points; rows come in
 * rising order. *thinning spreads those that are kept over the free samples of the whole frame. */
void roadpose_v_disparity_row(roadpose_v_disparity_t *histogram, roadpose_points_t *points,
                              const roadpose_free_map_t *free_map, const roadpose_row_t *samples, int16_t columns,
                              int16_t row, roadpose_thinning_t *thinning);

#endif
