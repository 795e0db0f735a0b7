/* v-disparity of the free map (the paper's v-disparity-free), and the points of the free map. */
#ifndef ROADPOSE_V_DISPARITY_H
#define ROADPOSE_V_DISPARITY_H

#include "roadpose/state.h"

/* Replaces row `row` of the histogram by the free samples of a decoded row, and clears the others of row_q8 to 0. */
void roadpose_v_disparity_row(roadpose_v_disparity_t *histogram, const roadpose_free_map_t *free_map,
                              uint16_t *row_q8, int16_t columns, int16_t row);

#endif
