/* Yaw over the drive: a robust mean of the remembered frames. */
#ifndef ROADPOSE_HEADING_RUNNING_YAW_H
#define ROADPOSE_HEADING_RUNNING_YAW_H

#include "roadpose/heading.h"

void roadpose_running_clear(roadpose_heading_t *instance);

/* Counts the frame; an accepted one joins the history. */
void roadpose_running_add(roadpose_heading_t *instance, const roadpose_yaw_t *yaw);

#endif
