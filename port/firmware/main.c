/* roadpose-firmware: the component on an emulated microcontroller, or on any hosted machine, for comparison.
 *     roadpose-firmware RECORDING FRAMES CAN_LOG [WORD...]
 * Plays the first FRAMES frames. The words are: method-1, no-refine, e2e-2, e2e-5; fields, which prints every field of
 * every frame as well; and cost, which tells on standard error what the frames cost. A debugger's command line has no
 * quotes: no argument contains a blank.
 * Exit status: 0 played to the end, 2 bad arguments, 3 unreadable recording. */
#include <stdlib.h>
#include <string.h>

#include "board.h"
#include "fault.h"
#include "player.h"
#include "roadpose/roadpose.h"

typedef struct {
    player_options_t play;
    bool tells_cost;
} options_t;

static bool take_word(options_t *options, const char *word) {
    if (strcmp(word, "method-1") == 0)
        options->play.settings.method = 1;
    else if (strcmp(word, "no-refine") == 0)
        options->play.settings.refine = false;
    else if (strcmp(word, "e2e-2") == 0)
        options->play.profile = ROADPOSE_E2E_PROFILE_2;
    else if (strcmp(word, "e2e-5") == 0)
        options->play.profile = ROADPOSE_E2E_PROFILE_5;
    else if (strcmp(word, "fields") == 0)
        options->play.tells_fields = true;
    else if (strcmp(word, "cost") == 0)
        options->tells_cost = true;
    else
        return fault(word, "is no word of this program");
    return true;
}

static bool take_arguments(options_t *options, const board_arguments_t *arguments) {
    int index;

    if (arguments->count < 4)
        return fault(NULL, "usage: roadpose-firmware RECORDING FRAMES CAN_LOG [WORD...]");
    options->play.folder = arguments->values[1];
    options->play.frames = (uint32_t)strtoul(arguments->values[2], NULL, 10);
    options->play.can_log = arguments->values[3];
    options->play.profile = ROADPOSE_E2E_PROFILE_1;
    roadpose_settings_default(&options->play.settings);
    for (index = 4; index < arguments->count; index++)
        if (!take_word(options, arguments->values[index]))
            return false;
    return true;
}

int main(int count, char *values[]) {
    static board_arguments_t arguments;
    static options_t options;

    board_start(&arguments, count, values);
    if (!take_arguments(&options, &arguments))
        return EXIT_BAD_ARGUMENTS;
    if (!player_play(&options.play))
        return EXIT_BAD_RECORDING;
    if (options.tells_cost)
        player_print_cost();
    return EXIT_SUCCESS;
}
