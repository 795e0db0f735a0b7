/* A machine with an operating system: nothing to start, and nothing to count with. */
#include "board.h"

void board_start(board_arguments_t *arguments, int count, char *const values[]) {
    arguments->count = 0;
    while (arguments->count < count && arguments->count < BOARD_ARGUMENTS_MAX) {
        arguments->values[arguments->count] = values[arguments->count];
        arguments->count++;
    }
}

uint32_t board_instructions(void) {
    return 0;
}
