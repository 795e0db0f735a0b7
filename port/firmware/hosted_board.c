/* A machine with an operating system: nothing to start, nothing to count with, one stack. */
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

void board_call(board_work_t *work, void *argument) {
    work(argument);
}

uint32_t board_stack_used(void) {
    return 0;
}
