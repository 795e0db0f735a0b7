/* roadpose: one image point in two frames. */
#ifndef ROADPOSE_TRACK_H
#define ROADPOSE_TRACK_H

#include <stdint.h>

/* Image coordinates of the rectified left image in 1/256 pixel, pixel centres at whole numbers: column u, row v of the
 * point in the previous frame (0) and in this one (1). Any value is allowed; what lies outside the image is not used. */
typedef struct {
    int32_t u0_q8;
    int32_t v0_q8;
    int32_t u1_q8;
    int32_t v1_q8;
} roadpose_track_t;

#endif
