/* The CSV on standard output. All numbers are printed from integers: the same digits from every compiler. */
#ifndef REPLAY_CSV_H
#define REPLAY_CSV_H

#include <stdio.h>

#include "roadpose/heading.h"
#include "roadpose/pose.h"

void csv_print_header(FILE *csv);

/* Yaw of a frame, and over the drive. */
typedef struct {
    roadpose_yaw_t frame;
    roadpose_running_yaw_t running;
} csv_yaw_t;

/* One line. Where there is no pose all number columns of the pose are empty, else those of axes that were not observed;
 * the same for the yaw. yaw NULL: the recording has no motion. */
void csv_print_frame(FILE *csv, uint32_t frame, const roadpose_pose_t *pose, const csv_yaw_t *yaw);

/* The same without motion. */
void csv_print_pose(FILE *csv, uint32_t frame, const roadpose_pose_t *pose);

#endif
