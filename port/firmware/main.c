/* roadpose-firmware: the component on an emulated microcontroller, or on any hosted machine, for comparison.
 *     roadpose-firmware RECORDING FRAMES CAN_LOG
 * Exit status: 0 played to the end, 2 bad arguments, 3 unreadable recording. */
#include <stdlib.h>

#include "board.h"
#include "fault.h"
#include "player.h"

int main(int count, char *values[]) {
    static board_arguments_t arguments;
    uint32_t frames;

    board_start(&arguments, count, values);
    if (arguments.count != 4) {
        (void)fault(NULL, "usage: roadpose-firmware RECORDING FRAMES CAN_LOG");
        return EXIT_BAD_ARGUMENTS;
    }
    frames = (uint32_t)strtoul(arguments.values[2], NULL, 10);
    return player_play(arguments.values[1], frames, arguments.values[3]) ? EXIT_SUCCESS : EXIT_BAD_RECORDING;
}
