/* The work of one frame, cut into phases and the phases into slices. */
#ifndef ROADPOSE_FRAME_WORK_H
#define ROADPOSE_FRAME_WORK_H

#include "roadpose/roadpose.h"

typedef enum {
    PHASE_IDLE = 0, /* no frame, no pose */
    PHASE_DONE,     /* a pose is ready */
    PHASE_CLEAR,    /* from here on a frame is running */
    PHASE_U_DISPARITY,
    PHASE_FREE_MAP,
    PHASE_V_DISPARITY,
    PHASE_PROFILE,     /* Method 1: hypotheses */
    PHASE_PROFILE_FIT, /*           least squares */
    PHASE_SORT_COUNT,  /* Method 2: points by disparity */
    PHASE_SORT_PLACES,
    PHASE_SORT_PLACE,
    PHASE_PAIRS,       /*           cloud of slopes and intercepts */
    PHASE_SLOPE,       /*           RANSAC for the slope */
    PHASE_SLOPE_FIT,
    PHASE_INTERCEPT,   /*           robust line through the intercepts */
    PHASE_INTERCEPT_FIT,
    PHASE_REFINE,
    PHASE_ASSESS,
    PHASE_INNER /* the inner half of the corridor is asked too */
} roadpose_phase_t;

/* Does one slice of the running phase and moves on where it is finished. */
void roadpose_work_slice(roadpose_t *instance);

/* Upper bound of the slices of a frame. */
uint32_t roadpose_work_slices_max(void);

#endif
