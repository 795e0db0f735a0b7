/* Plays frames of a recording as an ECU would see them: camera interrupt, cyclic task, CAN cycle. */
#ifndef ROADPOSE_PLAYER_H
#define ROADPOSE_PLAYER_H

#include <stdbool.h>
#include <stdint.h>

#include "roadpose/e2e.h"
#include "roadpose/rig.h"

typedef struct {
    const char *folder;  /* of the recording */
    uint32_t frames;     /* how many of folder/disparity/000000.pgm, 000001.pgm, ... */
    const char *can_log; /* file for what goes to the CAN bus, in the log format of can-utils */
    roadpose_settings_t settings;
    roadpose_e2e_profile_t profile;
    bool tells_fields; /* every field of a frame on a line of its own, after the CSV's */
} player_options_t;

/* Plays, and prints the CSV of roadpose-replay on standard output. False after a fault was reported on standard error. */
bool player_play(const player_options_t *options);

/* What the frames cost, on standard error, so that standard output stays the same on every machine. */
void player_print_cost(void);

#endif
