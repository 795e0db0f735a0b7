/* The frames of a recording in the order in which they are played. */
#ifndef REPLAY_RECORDING_H
#define REPLAY_RECORDING_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "fault.h"

typedef struct {
    char folder[PATH_BYTES]; /* .../disparity */
    char **names;            /* of the *.pgm in it, in name order (byte by byte) */
    size_t count;
    bool is_numbered; /* every name is a number of 1...9 digits */
} recording_t;

/* Lists the frames. Reports a fault and returns false if there is none. Close it in either case. */
bool recording_open(recording_t *recording, const char *path);
void recording_close(recording_t *recording);

/* What the CSV and truth.csv call the frame: the number that is its name, or, if any name of the recording is not a
 * number, its place in the order, from 0. */
uint32_t recording_frame_number(const recording_t *recording, size_t index);

/* Path of a frame's file; reports a fault and returns false if it is too long. */
bool recording_frame_path(const recording_t *recording, size_t index, char path[PATH_BYTES]);

#endif
