/* The library's own stack on a board, painted so that its use can be seen. */
#ifndef ROADPOSE_LIBRARY_STACK_H
#define ROADPOSE_LIBRARY_STACK_H

#include "board.h"

/* What a board supplies: calls work(argument) with the stack pointer at top, and puts it back. */
void board_call_on(board_work_t *work, void *argument, void *top);

#endif
