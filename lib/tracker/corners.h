/* Corners: where a patch can be told from its neighbours in every direction. */
#ifndef ROADPOSE_TRACKER_CORNERS_H
#define ROADPOSE_TRACKER_CORNERS_H

#include <stdbool.h>

#include "roadpose/tracker.h"

typedef struct {
    int32_t u;
    int32_t v;
} roadpose_corner_t;

/* Best corner of one cell of the grid, at least ROADPOSE_TRACKER_MARGIN from the border. False: none is strong
 * enough. */
bool roadpose_corner_of_cell(const roadpose_grey_t *image, unsigned column, unsigned row, uint16_t corner_min,
                             roadpose_corner_t *corner);

#endif
