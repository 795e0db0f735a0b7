/* The motion of the camera between two frames, as the flow field shows it. */
#ifndef ROADPOSE_HEADING_EXPANSION_H
#define ROADPOSE_HEADING_EXPANSION_H

#include <stdint.h>

/* Focus of expansion (|focus| <= 1 in each component) and rotation about the camera's axes (radians, |turn| <= 1/4). */
typedef struct {
    int32_t focus_q24[2];
    int32_t turn_q24[3];
} roadpose_expansion_t;

#endif
