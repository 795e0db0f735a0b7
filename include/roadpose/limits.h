/* roadpose: compile-time limits.
 *
 * Every array of the library has a size fixed here. Override a limit on the compiler's command line
 * (-DROADPOSE_MAX_WIDTH=1280) in the library AND in everything that includes its headers; the CMake target
 * `roadpose` passes the right ones on. A limit that cannot work stops the build with a message that says what to
 * change. The sampling steps change which pixels are read, so they change results; the other limits only change
 * what fits: a frame that fits two builds with the same steps, points and pairs gives the same bits in both, where its
 * road, matched or not, stays below ROADPOSE_MAX_DISPARITY of both down to the last row.
 *
 * | limit                   | default | small profile | raise it when                                              |
 * |-------------------------|---------|---------------|------------------------------------------------------------|
 * | ROADPOSE_MAX_WIDTH      | 640     | 640           | the disparity image is wider                               |
 * | ROADPOSE_MAX_HEIGHT     | 480     | 480           | the disparity image is higher                              |
 * | ROADPOSE_MAX_DISPARITY  | 128     | 128           | the stereo engine searches further; whole pixels           |
 * | ROADPOSE_ROW_STEP       | 2       | 4             | lower it for more pixels, raise it for less memory, time   |
 * | ROADPOSE_COLUMN_STEP    | 4       | 8             | the same, for columns                                      |
 * | ROADPOSE_MAX_POINTS     | 8192    | 2048          | the road covers more samples and memory allows             |
 * | ROADPOSE_MAX_PAIRS      | 512     | 512           | Method 2 without refinement is to be steadier              |
 */
#ifndef ROADPOSE_LIMITS_H
#define ROADPOSE_LIMITS_H

#include <stdint.h>

/* The small profile is for microcontrollers that can give the library 64 KiB of RAM in all. */
#ifdef ROADPOSE_SMALL_PROFILE
#define ROADPOSE_DEFAULT_ROW_STEP 4
#define ROADPOSE_DEFAULT_COLUMN_STEP 8
#define ROADPOSE_DEFAULT_MAX_POINTS 2048
#else
#define ROADPOSE_DEFAULT_ROW_STEP 2
#define ROADPOSE_DEFAULT_COLUMN_STEP 4
#define ROADPOSE_DEFAULT_MAX_POINTS 8192
#endif

#ifndef ROADPOSE_MAX_WIDTH
#define ROADPOSE_MAX_WIDTH 640
#endif
#ifndef ROADPOSE_MAX_HEIGHT
#define ROADPOSE_MAX_HEIGHT 480
#endif
#ifndef ROADPOSE_MAX_DISPARITY
#define ROADPOSE_MAX_DISPARITY 128
#endif
#ifndef ROADPOSE_ROW_STEP
#define ROADPOSE_ROW_STEP ROADPOSE_DEFAULT_ROW_STEP
#endif
#ifndef ROADPOSE_COLUMN_STEP
#define ROADPOSE_COLUMN_STEP ROADPOSE_DEFAULT_COLUMN_STEP
#endif
#ifndef ROADPOSE_MAX_POINTS
#define ROADPOSE_MAX_POINTS ROADPOSE_DEFAULT_MAX_POINTS
#endif

#ifndef ROADPOSE_MAX_PAIRS
#define ROADPOSE_MAX_PAIRS 512
#endif

#if ROADPOSE_MAX_WIDTH < 64 || ROADPOSE_MAX_WIDTH > 2048
#error "roadpose: set ROADPOSE_MAX_WIDTH to 64...2048: the fixed-point ranges are proved up to 2048 columns"
#endif
#if ROADPOSE_MAX_HEIGHT < 64 || ROADPOSE_MAX_HEIGHT > 1536
#error "roadpose: set ROADPOSE_MAX_HEIGHT to 64...1536: the fixed-point ranges are proved up to 1536 rows"
#endif
#if ROADPOSE_MAX_DISPARITY < 32 || ROADPOSE_MAX_DISPARITY > 256 || ROADPOSE_MAX_DISPARITY % 32 != 0
#error "roadpose: set ROADPOSE_MAX_DISPARITY to a multiple of 32 in 32...256: the free map keeps 32 levels a word"
#endif
#if ROADPOSE_ROW_STEP < 1 || ROADPOSE_ROW_STEP > 16
#error "roadpose: set ROADPOSE_ROW_STEP to 1...16: beyond that too few rows of road are left"
#endif
#if ROADPOSE_COLUMN_STEP < 1 || ROADPOSE_COLUMN_STEP > 16
#error "roadpose: set ROADPOSE_COLUMN_STEP to 1...16: beyond that too few columns of road are left"
#endif
#if ROADPOSE_MAX_POINTS < 512 || ROADPOSE_MAX_POINTS > 16384
#error "roadpose: set ROADPOSE_MAX_POINTS to 512...16384: the sums of the refinement are proved up to 16384 points"
#endif

#if ROADPOSE_MAX_PAIRS < 64 || ROADPOSE_MAX_PAIRS > 1024
#error "roadpose: set ROADPOSE_MAX_PAIRS to 64...1024: one RANSAC hypothesis looks at all of them in one slice"
#endif

/* Size of the sampling grid: one sample for every ROW_STEP rows and COLUMN_STEP columns. */
#define ROADPOSE_MAX_GRID_ROWS ((ROADPOSE_MAX_HEIGHT + ROADPOSE_ROW_STEP - 1) / ROADPOSE_ROW_STEP)
#define ROADPOSE_MAX_GRID_COLUMNS ((ROADPOSE_MAX_WIDTH + ROADPOSE_COLUMN_STEP - 1) / ROADPOSE_COLUMN_STEP)

#if ROADPOSE_MAX_GRID_COLUMNS > 1024 || ROADPOSE_MAX_GRID_ROWS > 1024
#error "roadpose: raise ROADPOSE_COLUMN_STEP or ROADPOSE_ROW_STEP: a grid side of more than 1024 is not proved"
#endif

/* Samples that one slice of work decodes at most; other work is cut to about the same cost. */
#define ROADPOSE_SLICE_SAMPLES 1024u

/* A histogram cell holds at most one count for each grid row (u-disparity) or grid column (v-disparity). */
#if ROADPOSE_MAX_GRID_ROWS > 255 || ROADPOSE_MAX_GRID_COLUMNS > 255
typedef uint16_t roadpose_count_t;
#else
typedef uint8_t roadpose_count_t;
#endif

#endif
