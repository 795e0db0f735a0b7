/* rig.yml of a recording: the rig, how its samples are to be read, and the frame rate. */
#ifndef REPLAY_RIG_FILE_H
#define REPLAY_RIG_FILE_H

#include <stdbool.h>
#include <stdint.h>

#include "roadpose/roadpose.h"

typedef struct {
    roadpose_rig_t rig;
    roadpose_disparity_format_t format; /* of the samples as the estimator gets them */
    bool is_rescaled;                   /* samples must be rescaled first: the scale is no power of two, 1...32768 */
    int64_t scale_micro;                /* sample / scale = disparity in pixels; millionths */
    uint16_t invalid;                   /* sample of the file that means "no match" */
    int64_t rate_millihz;
} rig_file_t;

/* Reads and checks the file; reports the first fault and returns false. */
bool rig_file_read(rig_file_t *rig_file, const char *path);

/* Rescales one sample of the file to the format's 1/256 px. */
uint16_t rig_file_rescale(const rig_file_t *rig_file, uint16_t sample);

#endif
