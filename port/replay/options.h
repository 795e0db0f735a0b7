/* The command line. */
#ifndef REPLAY_OPTIONS_H
#define REPLAY_OPTIONS_H

#include "roadpose/roadpose.h"

typedef struct {
    roadpose_settings_t settings;
    const char *recording;
} options_t;

typedef enum {
    OPTIONS_PLAY, /* *options is filled */
    OPTIONS_HELP, /* --help was asked for and printed */
    OPTIONS_BAD   /* a fault was reported */
} options_result_t;

options_result_t options_parse(options_t *options, int count, char *const arguments[]);

#endif
