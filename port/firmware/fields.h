/* Every field that the component gives, in full: more than the CSV of roadpose-replay has. */
#ifndef ROADPOSE_FIELDS_H
#define ROADPOSE_FIELDS_H

#include "csv.h"
#include "roadpose/camera_port.h"

/* One line of a frame on standard output. yaw NULL: the recording has no motion. */
void fields_print(const roadpose_pose_t *pose, const csv_yaw_t *yaw, const roadpose_camera_counters_t *counters);

#endif
