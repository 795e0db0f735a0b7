/* --pictures: an overlay for people of what the estimator made of each frame. The plain build has none of it
 * (pictures_absent.c); host_tests/evaluation builds roadpose-replay-pictures, which draws with OpenCV. */
#ifndef REPLAY_PICTURES_H
#define REPLAY_PICTURES_H

#include <stdbool.h>
#include <stdint.h>

#include "roadpose/roadpose.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    const char *folder;         /* for the pictures */
    const char *recording;      /* its left/ is the background, where there is an image of the frame */
    const char *disparity_path; /* of the frame: gives the picture its name */
    const uint8_t *samples;     /* of the frame, in the format's byte order */
    const roadpose_rig_t *rig;
    const roadpose_disparity_format_t *format;
    const roadpose_t *estimator; /* has finished this frame */
} picture_t;

/* Makes the folder ready; NULL: no pictures are wanted. Reports a fault and returns false if it cannot. */
bool pictures_open(const char *folder);

/* Writes one picture. Reports a fault and returns false if it cannot. */
bool pictures_draw(const picture_t *picture);

#ifdef __cplusplus
}
#endif

#endif
