/* What must hold for every pose. */
#ifndef ROADPOSE_TEST_POSE_CHECKS_H
#define ROADPOSE_TEST_POSE_CHECKS_H

#include <stdbool.h>

#include "roadpose/pose.h"
#include "roadpose/rig.h"

/* Field by field: padding does not count. */
bool same_pose(const roadpose_pose_t *left, const roadpose_pose_t *right);

/* NULL, or what is wrong: a status that is none, a refused frame with a pose, figures that contradict each other or
 * the settings. */
const char *pose_fault(const roadpose_pose_t *pose, const roadpose_settings_t *settings);

#endif
