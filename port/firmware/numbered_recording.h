/* A recording without a file system that can list folders: its frames are 000000.pgm, 000001.pgm, ... */
#ifndef ROADPOSE_NUMBERED_RECORDING_H
#define ROADPOSE_NUMBERED_RECORDING_H

#include "recording.h"

#define NUMBERED_FRAMES_MAX 100

/* Opens the first frames of a recording, without a look at them; from then on recording_frame_number() and
 * recording_frame_path() answer as for any recording. Nothing is to be closed. Reports a fault and returns false. */
bool numbered_recording_open(recording_t *recording, const char *path, uint32_t frames);

#endif
