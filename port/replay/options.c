#include "options.h"

#include <stdio.h>
#include <string.h>

#include "decimal.h"
#include "fault.h"
#include "socketcan.h"

#define HINT "; try --help"

static const char help_text[] =
    "Usage: roadpose-replay [options] RECORDING\n"
    "Plays a recording of disparity maps and prints pitch, roll and height over the road, one CSV line a frame; and yaw\n"
    "where it has tracks/*.csv, or left/*.pgm for every frame.\n"
    "\n"
    "  --method 1|2       1: road profile, roll taken as zero; 2: ground plane (default)\n"
    "  --no-refine        the method alone, without least squares on the road points after it\n"
    "  --corridor METRES  road further sideways does not count: 0.5...100, 0 = no limit (default 2)\n"
    "  --range METRES     road further ahead does not count: 5...500, 0 = no limit (default 25)\n"
    "  --points PERCENT   share of the points that method 2 pairs: 1...100 (default 100)\n"
    "  --seed N           of the random numbers: 0...4294967295 (default 1)\n"
    "  --can IFACE        send the poses on this CAN interface too, at the pace of the recording\n"
    "  --candump FILE     write the CAN frames as a log of can-utils, with the recording's times; - is standard "
    "output,\n"
    "                     then without the CSV\n"
    "  --e2e PROFILE      AUTOSAR E2E profile of the CAN frames: 1, 2 or 5 (default 1)\n"
    "  --speed FACTOR     1 is the pace of the recording, 2 twice as fast: up to 1000; 0 as fast as possible "
    "(default,\n"
    "                     but 1 with --can)\n"
    "  --pictures DIR     write an overlay of each frame into this folder (roadpose-replay-pictures only)\n"
    "  --help             this text\n"
    "\n"
    "RECORDING is a folder with rig.yml and disparity/*.pgm. pitch + = nose down, roll + = right side down, degrees;\n"
    "height of the left camera in metres; yaw + = camera looks left of the direction of travel; status and yaw_status ok,\n"
    "or why there is no pose or yaw. An empty field was not observed.\n"
    "Exit status: 0 played to the end, 1 output cannot be written, 2 bad arguments, 3 bad recording.\n";

typedef enum {
    NUMBER_METHOD,
    NUMBER_CORRIDOR,
    NUMBER_RANGE,
    NUMBER_POINTS,
    NUMBER_SEED,
    NUMBER_E2E,
    NUMBER_SPEED,
    NUMBER_COUNT
} number_t;

/* Options with a number; the limits are scaled by 10^places. */
static const struct {
    const char *name;
    int places;
    bool zero_is_no_limit;
    int64_t least;
    int64_t most;
} numbers[NUMBER_COUNT] = {
    [NUMBER_METHOD] = {"--method", 0, false, 1, 2},      [NUMBER_CORRIDOR] = {"--corridor", 3, true, 500, 100000},
    [NUMBER_RANGE] = {"--range", 3, true, 5000, 500000}, [NUMBER_POINTS] = {"--points", 0, false, 1, 100},
    [NUMBER_SEED] = {"--seed", 0, false, 0, UINT32_MAX}, [NUMBER_E2E] = {"--e2e", 0, false, 1, 5},
    [NUMBER_SPEED] = {"--speed", 3, false, 0, 1000000},
};

static void store(options_t *options, number_t option, int64_t value) {
    roadpose_settings_t *settings = &options->settings;

    switch (option) {
    case NUMBER_METHOD:
        settings->method = (uint8_t)value;
        break;
    case NUMBER_CORRIDOR:
        settings->corridor_half_width_mm = (int32_t)value;
        break;
    case NUMBER_RANGE:
        settings->corridor_range_mm = (int32_t)value;
        break;
    case NUMBER_POINTS:
        settings->points_percent = (uint8_t)value;
        break;
    case NUMBER_SEED:
        settings->seed = (uint32_t)value;
        break;
    case NUMBER_E2E:
        options->e2e_profile = (uint8_t)value;
        break;
    case NUMBER_SPEED:
        options->has_speed = true;
        options->speed_permille = (uint32_t)value;
        break;
    case NUMBER_COUNT:
        break;
    }
}

static bool refuse_range(number_t option, const char *text) {
    char least[DECIMAL_TEXT_BYTES], most[DECIMAL_TEXT_BYTES];

    decimal_print_short(least, numbers[option].least, numbers[option].places);
    decimal_print_short(most, numbers[option].most, numbers[option].places);
    return fault(NULL, "%s %.40s is outside %s...%s%s" HINT, numbers[option].name, text, least, most,
                 numbers[option].zero_is_no_limit ? " and not 0 (no limit)" : "");
}

static bool take_number(options_t *options, number_t option, const char *text) {
    decimal_t number;

    if (text == NULL)
        return fault(NULL, "%s needs a number" HINT, numbers[option].name);
    if (!decimal_parse(text, numbers[option].places, &number))
        return fault(NULL, "%s '%.40s' is not a number" HINT, numbers[option].name, text);
    if (numbers[option].zero_is_no_limit && number.scaled == 0 && number.is_exact) {
        store(options, option, 0);
        return true;
    }
    if (number.scaled < numbers[option].least || number.scaled > numbers[option].most)
        return refuse_range(option, text);
    if (numbers[option].places == 0 && !number.is_exact)
        return fault(NULL, "%s %.40s is not a whole number" HINT, numbers[option].name, text);
    if (option == NUMBER_E2E && (number.scaled == 3 || number.scaled == 4))
        return fault(NULL, "--e2e %.40s is none of 1, 2, 5" HINT, text);
    store(options, option, number.scaled);
    return true;
}

static number_t find_number(const char *name) {
    number_t option = NUMBER_METHOD;

    while (option < NUMBER_COUNT && strcmp(name, numbers[option].name) != 0)
        option++;
    return option;
}

static bool take_recording(options_t *options, const char *argument) {
    if (options->recording != NULL)
        return fault(NULL, "one recording at a time, not '%.200s' as well" HINT, argument);
    if (*argument == '\0')
        return fault(NULL, "the recording has no name" HINT);
    options->recording = argument;
    return true;
}

/* Where an option with a name after it keeps it; NULL for any other option. */
static const char **find_name(options_t *options, const char *argument) {
    if (strcmp(argument, "--can") == 0)
        return &options->can_interface;
    if (strcmp(argument, "--pictures") == 0)
        return &options->pictures_folder;
    return strcmp(argument, "--candump") == 0 ? &options->candump_path : NULL;
}

static bool take_name(const char **name, const char *option, const char *text) {
    if (text == NULL || *text == '\0')
        return fault(NULL, "%s needs a name" HINT, option);
    *name = text;
    return true;
}

/* Takes the argument at *index and moves *index past it. text after "--" is a recording, whatever it looks like. */
static bool take_argument(options_t *options, char *const arguments[], int *index, bool *only_recordings) {
    const char *argument = arguments[(*index)++];
    const number_t option = find_number(argument);
    const char **name = find_name(options, argument);

    if (*only_recordings || argument[0] != '-' || argument[1] == '\0')
        return take_recording(options, argument);
    if (option != NUMBER_COUNT || name != NULL) {
        const char *text = arguments[*index]; /* the list ends with NULL */

        *index += text != NULL ? 1 : 0;
        return name != NULL ? take_name(name, argument, text) : take_number(options, option, text);
    }
    if (strcmp(argument, "--no-refine") == 0)
        options->settings.refine = false;
    else if (strcmp(argument, "--") == 0)
        *only_recordings = true;
    else
        return fault(NULL, "unknown option '%.200s'" HINT, argument);
    return true;
}

options_result_t options_parse(options_t *options, int count, char *const arguments[]) {
    bool only_recordings = false;
    int index = 1;

    memset(options, 0, sizeof *options);
    options->e2e_profile = 1;
    roadpose_settings_default(&options->settings);
    while (index < count) {
        if (!only_recordings && strcmp(arguments[index], "--help") == 0) {
            (void)fputs(help_text, stdout);
            return OPTIONS_HELP;
        }
        if (!take_argument(options, arguments, &index, &only_recordings))
            return OPTIONS_BAD;
    }
    if (options->recording == NULL) {
        (void)fault(NULL, "no recording given" HINT);
        return OPTIONS_BAD;
    }
    if (options->can_interface != NULL && strlen(options->can_interface) >= ROADPOSE_SOCKETCAN_NAME_BYTES) {
        (void)fault(NULL, "--can '%.40s' is not a name for an interface" HINT, options->can_interface);
        return OPTIONS_BAD;
    }
    if (!options->has_speed)
        options->speed_permille = options->can_interface != NULL ? 1000u : 0u;
    return OPTIONS_PLAY;
}
