#include "library_stack.h"

#include <stdbool.h>

#define WORDS (BOARD_LIBRARY_STACK_BYTES / sizeof(uint32_t))
#define PAINT UINT32_C(0x5AFEC0DE)

static BOARD_LIBRARY_RAM uint32_t stack[WORDS] __attribute__((aligned(16)));
static bool is_painted;

void board_call(board_work_t *work, void *argument) {
    unsigned i;

    for (i = 0; !is_painted && i < WORDS; i++)
        stack[i] = PAINT;
    is_painted = true;
    board_call_on(work, argument, stack + WORDS);
}

uint32_t board_stack_used(void) {
    unsigned unused = 0;

    while (is_painted && unused < WORDS && stack[unused] == PAINT)
        unused++;
    return is_painted ? (uint32_t)((WORDS - unused) * sizeof(uint32_t)) : 0;
}
