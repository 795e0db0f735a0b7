/* Checks of what the caller hands in. */
#ifndef ROADPOSE_ARGUMENTS_H
#define ROADPOSE_ARGUMENTS_H

#include "roadpose/roadpose.h"

/* ROADPOSE_OK, ROADPOSE_ERROR_RIG or ROADPOSE_ERROR_SIZE. */
roadpose_result_t roadpose_check_rig(const roadpose_rig_t *rig);

/* ROADPOSE_OK or ROADPOSE_ERROR_SETTINGS. */
roadpose_result_t roadpose_check_settings(const roadpose_settings_t *settings);

/* ROADPOSE_OK, ROADPOSE_ERROR_NULL, ROADPOSE_ERROR_SIZE or ROADPOSE_ERROR_STRIDE. */
roadpose_result_t roadpose_check_frame(const roadpose_t *instance, const roadpose_frame_t *frame);

#endif
