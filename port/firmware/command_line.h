/* The command line that a debugger or emulator gives to a program without an operating system. */
#ifndef ROADPOSE_COMMAND_LINE_H
#define ROADPOSE_COMMAND_LINE_H

#include "board.h"

#define COMMAND_LINE_BYTES 1024

/* Cuts text, which it changes and which must live on, at its blanks. */
void command_line_split(board_arguments_t *arguments, char *text);

#endif
