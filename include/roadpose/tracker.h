/* roadpose: a feature tracker for systems without a flow engine. It makes the tracks that roadpose/heading.h wants
 * from two left images: the best corner of each cell of a grid, found again by block matching from coarse to fine and
 * placed to a fraction of a pixel.
 *
 * Sources of the methods: corners by Forstner and Gulch (1987), det / trace of the gradient matrix; sub-pixel
 * placement by Lucas and Kanade (1981) with the gradients of the previous image (Baker and Matthews, 2004).
 *
 * Optional: with ROADPOSE_TRACKER=0 for the library and everything that includes its headers, there is none of it.
 * Every function is re-entrant: no global state, no heap, no floating point, no clock. One instance must not be used
 * from two threads at the same time. The same images give the same bits on every machine. */
#ifndef ROADPOSE_TRACKER_H
#define ROADPOSE_TRACKER_H

#ifndef ROADPOSE_TRACKER
#define ROADPOSE_TRACKER 1
#endif

#include <stddef.h>
#include <stdint.h>

#include "roadpose/roadpose.h"
#include "roadpose/track.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Cells of the corner grid; each gives at most one track. */
#define ROADPOSE_TRACKER_COLUMNS 20
#define ROADPOSE_TRACKER_ROWS 12
#define ROADPOSE_TRACKER_CELLS (ROADPOSE_TRACKER_COLUMNS * ROADPOSE_TRACKER_ROWS)

/* A corner is looked for this many pixels to each side in the present image. */
#ifndef ROADPOSE_TRACKER_RANGE
#define ROADPOSE_TRACKER_RANGE 32
#endif
#if ROADPOSE_TRACKER_RANGE < 8 || ROADPOSE_TRACKER_RANGE > 64 || ROADPOSE_TRACKER_RANGE % 4 != 0
#error "roadpose: set ROADPOSE_TRACKER_RANGE to a multiple of 4 in 8...64: the search window is sized for it"
#endif

/* A borrowed 8-bit image in rows. Not kept after the call. */
typedef struct {
    const uint8_t *pixels;  /* first row, first column */
    uint32_t stride_bytes;  /* from one row to the next, >= width_px */
    uint16_t width_px;      /* 64...ROADPOSE_MAX_WIDTH */
    uint16_t height_px;     /* 64...ROADPOSE_MAX_HEIGHT */
} roadpose_grey_t;

/* Settings. Take roadpose_tracker_settings_default() and change what you must: a zeroed struct is refused. */
typedef struct {
    uint16_t corner_min;          /* weakest corner, det / trace of the sums over 5 x 5 pixels of squared differences of
                                     grey levels two pixels apart, 1...60 000. Default 800 */
    uint8_t mismatch_max_percent; /* largest mean difference of the matched patches, of the patch's own mean deviation
                                     from its mean, 1...100. Default 40 */
} roadpose_tracker_settings_t;

/* Private: sums of 4 x 4 pixels around a corner, 7 x 7 of them for the corner and more for where it is looked for. */
#define ROADPOSE_TRACKER_BLOCK 7
#define ROADPOSE_TRACKER_WINDOW (ROADPOSE_TRACKER_BLOCK + ROADPOSE_TRACKER_RANGE / 2)
#define ROADPOSE_TRACKER_PATCH 11

typedef struct {
    uint32_t ready;
    roadpose_tracker_settings_t settings;
    uint16_t block[ROADPOSE_TRACKER_BLOCK][ROADPOSE_TRACKER_BLOCK];
    uint16_t window[ROADPOSE_TRACKER_WINDOW][ROADPOSE_TRACKER_WINDOW];
    int16_t patch[ROADPOSE_TRACKER_PATCH][ROADPOSE_TRACKER_PATCH];
    int16_t gradient_u[ROADPOSE_TRACKER_PATCH][ROADPOSE_TRACKER_PATCH];
    int16_t gradient_v[ROADPOSE_TRACKER_PATCH][ROADPOSE_TRACKER_PATCH];
} roadpose_tracker_t;

#if ROADPOSE_TRACKER

/* Fills *settings with the defaults above. Does nothing on NULL. Constant time. */
void roadpose_tracker_settings_default(roadpose_tracker_settings_t *settings);

/* Makes *tracker ready. settings may be NULL: the defaults. tracker: caller's memory of sizeof(roadpose_tracker_t)
 * bytes, any content. Returns ROADPOSE_OK, or ROADPOSE_ERROR_NULL, _SETTINGS with *tracker unchanged. Constant time. */
roadpose_result_t roadpose_tracker_init(roadpose_tracker_t *tracker, const roadpose_tracker_settings_t *settings);

/* Tracks from the previous to the present image: at most capacity, and at most ROADPOSE_TRACKER_CELLS. The caller keeps
 * the previous image; both are borrowed for the call. tracks: caller's array of capacity tracks, in the order of the
 * cells; *count: how many were written. Returns ROADPOSE_OK, or ROADPOSE_ERROR_NULL, _ORDER (not initialised), _SIZE
 * (an image is too small or too large, or they differ), _STRIDE; then nothing is written.
 * Cost for each cell: at most 121 places looked at for a corner, (RANGE / 2 + 1)^2 * 49 + 1225 block differences, and
 * 10 placements of a patch of 121 pixels. */
roadpose_result_t roadpose_tracker_track(roadpose_tracker_t *tracker, const roadpose_grey_t *previous,
                                         const roadpose_grey_t *present, roadpose_track_t *tracks, size_t capacity,
                                         size_t *count);

#endif

#ifdef __cplusplus
}
#endif

#endif
