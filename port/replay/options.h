/* The command line. */
#ifndef REPLAY_OPTIONS_H
#define REPLAY_OPTIONS_H

#include "roadpose/roadpose.h"

typedef struct {
    roadpose_settings_t settings;
    const char *recording;
    const char *can_interface; /* NULL: not asked for */
    const char *candump_path;  /* NULL: not asked for; "-": standard output, then without the CSV */
    const char *pictures_folder; /* NULL: not asked for */
    uint8_t e2e_profile;       /* of the CAN frames: 1, 2 or 5 */
    bool has_speed;            /* speed_permille was given */
    uint32_t speed_permille;   /* 1000: as recorded; 0: as fast as possible */
} options_t;

typedef enum {
    OPTIONS_PLAY, /* *options is filled */
    OPTIONS_HELP, /* --help was asked for and printed */
    OPTIONS_BAD   /* a fault was reported */
} options_result_t;

options_result_t options_parse(options_t *options, int count, char *const arguments[]);

#endif
