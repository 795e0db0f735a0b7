/* Plays frames of a recording as an ECU would see them: camera interrupt, cyclic task, CAN cycle. */
#ifndef ROADPOSE_PLAYER_H
#define ROADPOSE_PLAYER_H

#include <stdbool.h>
#include <stdint.h>

/* Plays folder/disparity/000000.pgm, 000001.pgm, ... (count of them); prints the CSV of roadpose-replay on standard output and
 * writes what went to the CAN bus to the file can_log, in the log format of can-utils. False after a fault was
 * reported on standard error. */
bool player_play(const char *folder, uint32_t count, const char *can_log);

#endif
