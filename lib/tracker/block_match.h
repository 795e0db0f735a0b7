/* Block matching from coarse to fine. */
#ifndef ROADPOSE_TRACKER_BLOCK_MATCH_H
#define ROADPOSE_TRACKER_BLOCK_MATCH_H

#include "tracker/corners.h"

/* Where the corner of the previous image is in the present one, to about a pixel. False: nowhere within range. */
bool roadpose_block_match(roadpose_tracker_t *tracker, const roadpose_grey_t *previous, const roadpose_grey_t *present,
                          const roadpose_corner_t *corner, roadpose_corner_t *found);

#endif
