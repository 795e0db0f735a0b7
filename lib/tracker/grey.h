/* Reading an 8-bit image. */
#ifndef ROADPOSE_TRACKER_GREY_H
#define ROADPOSE_TRACKER_GREY_H

#include "roadpose/tracker.h"

/* Pixels that everything below reads to each side of a corner at most: 3.5 blocks of 4. */
#define ROADPOSE_TRACKER_MARGIN 14

/* 0 <= u < width, 0 <= v < height. */
static inline const uint8_t *roadpose_grey_at(const roadpose_grey_t *image, int32_t u, int32_t v) {
    return image->pixels + (size_t)v * image->stride_bytes + (size_t)u;
}

#endif
