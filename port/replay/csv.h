/* The CSV on standard output. All numbers are printed from integers: the same digits from every compiler. */
#ifndef REPLAY_CSV_H
#define REPLAY_CSV_H

#include <stdio.h>

#include "roadpose/pose.h"

void csv_print_header(FILE *csv);

/* One line. Where there is no pose all number columns are empty, else those of axes that were not observed. */
void csv_print_pose(FILE *csv, uint32_t frame, const roadpose_pose_t *pose);

#endif
