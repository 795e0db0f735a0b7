/* Reader of recordings for tests and benchmarks. On purpose not the reader of roadpose-replay: the two check each
 * other. Frames are taken as disparity/000000.pgm, 000001.pgm and so on, without a gap. */
#ifndef ROADPOSE_TEST_RECORDING_FILE_H
#define ROADPOSE_TEST_RECORDING_FILE_H

#include <stdbool.h>
#include <stdint.h>

#include "roadpose/disparity.h"
#include "roadpose/rig.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    int width;
    int height;
    double focal_px;
    double cu_px;
    double cv_px;
    double baseline_m;
    double disparity_scale;
    double invalid;
    double disparity_offset_px;
} recording_rig_t;

typedef struct {
    bool known; /* truth.csv has a line for this frame */
    bool road;
    double pitch_deg;
    double roll_deg;
    double height_m;
    char scene[40];
} recording_truth_t;

typedef struct {
    char folder[1024];
    char name[128]; /* last part of the folder's path */
    recording_rig_t rig;
    int frames;
    recording_truth_t *truth; /* one a frame */
} recording_t;

/* False, with one line on standard error, when the folder is no readable recording. */
bool recording_open(recording_t *recording, const char *folder);
void recording_close(recording_t *recording);

/* Samples as the file has them: 2 * width * height bytes, big-endian. */
bool recording_read_disparity(const recording_t *recording, int frame, uint8_t *samples);

/* One byte a pixel, 1 = true road. False, silently, when the recording has no such mask. */
bool recording_read_road(const recording_t *recording, int frame, uint8_t *mask);

/* What roadpose_init() needs to read such frames. False when disparity_scale is no power of two up to 2^15. */
bool recording_describe(const recording_t *recording, roadpose_rig_t *rig, roadpose_disparity_format_t *format);

#ifdef __cplusplus
}
#endif

#endif
