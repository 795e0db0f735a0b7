/* The part of a frame's work that is Method 1 or Method 2. */
#ifndef ROADPOSE_METHOD_WORK_H
#define ROADPOSE_METHOD_WORK_H

#include "frame_work.h"

void roadpose_method_slice(roadpose_t *instance);
uint32_t roadpose_method_slices_max(void);

/* Starts a phase from its first slice. */
void roadpose_enter(roadpose_t *instance, roadpose_phase_t phase);

/* Ends the frame without a pose. */
void roadpose_finish(roadpose_t *instance, roadpose_status_t status);

#endif
