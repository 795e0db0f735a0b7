/* Placing a patch to a fraction of a pixel. */
#ifndef ROADPOSE_TRACKER_SUB_PIXEL_H
#define ROADPOSE_TRACKER_SUB_PIXEL_H

#include "tracker/corners.h"

/* Where the patch around the corner of the previous image lies in the present one, starting from *start. False: it
 * leaves the image, strays, or does not look alike. */
bool roadpose_sub_pixel(roadpose_tracker_t *tracker, const roadpose_grey_t *previous, const roadpose_grey_t *present,
                        const roadpose_corner_t *corner, const roadpose_corner_t *start, roadpose_track_t *track);

#endif
