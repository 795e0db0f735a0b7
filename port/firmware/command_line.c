#include "command_line.h"

void command_line_split(board_arguments_t *arguments, char *text) {
    arguments->count = 0;
    while (arguments->count < BOARD_ARGUMENTS_MAX) {
        while (*text == ' ')
            *text++ = '\0';
        if (*text == '\0')
            return;
        arguments->values[arguments->count++] = text;
        while (*text != ' ' && *text != '\0')
            text++;
    }
}
