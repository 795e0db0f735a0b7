#include "numbered_recording.h"

#include <inttypes.h>
#include <stdio.h>

#define NAME_BYTES 16

bool numbered_recording_open(recording_t *recording, const char *path, uint32_t frames) {
    static char texts[NUMBERED_FRAMES_MAX][NAME_BYTES];
    static char *names[NUMBERED_FRAMES_MAX];
    uint32_t index;

    if (frames > NUMBERED_FRAMES_MAX)
        return fault(path, "the firmware plays at most %d frames", NUMBERED_FRAMES_MAX);
    for (index = 0; index < frames; index++) {
        (void)snprintf(texts[index], NAME_BYTES, "%06" PRIu32 ".pgm", index);
        names[index] = texts[index];
    }
    recording->names = names;
    recording->count = frames;
    recording->is_numbered = true;
    return join_path(recording->folder, path, "disparity");
}

uint32_t recording_frame_number(const recording_t *recording, size_t index) {
    (void)recording;
    return (uint32_t)index;
}

bool recording_frame_path(const recording_t *recording, size_t index, char path[PATH_BYTES]) {
    return join_path(path, recording->folder, recording->names[index]);
}
