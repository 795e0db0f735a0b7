/* RV32 under an emulator or debugger with semihosting: the command line, and the core's own counter of instructions. */
#include "board.h"

#include <stddef.h>

#include "command_line.h"
#include "library_stack.h"

#define SEMIHOSTING_GET_COMMAND_LINE 0x15

static uint32_t last_count;

/* These three instructions, uncompressed and within one page, are what a debugger looks for. */
static int32_t semihosting(int32_t operation, void *block) {
    register int32_t a0 __asm__("a0") = operation;
    register void *a1 __asm__("a1") = block;
    __asm__ volatile(".option push\n .option norvc\n .balign 16\n"
                     " slli zero, zero, 0x1f\n ebreak\n srai zero, zero, 7\n"
                     " .option pop"
                     : "+r"(a0)
                     : "r"(a1)
                     : "memory");
    return a0;
}

void board_start(board_arguments_t *arguments, int count, char *const values[]) {
    static char line[COMMAND_LINE_BYTES];
    struct {
        char *text;
        uint32_t bytes;
    } block = {line, sizeof line};

    (void)count;
    (void)values;
    arguments->count = 0;
    if (semihosting(SEMIHOSTING_GET_COMMAND_LINE, &block) == 0)
        command_line_split(arguments, line);
    (void)board_instructions();
}

/* The low half is enough: differences are taken modulo 2^32. */
uint32_t board_instructions(void) {
    uint32_t count, passed;

    __asm__ volatile("csrr %0, minstret" : "=r"(count));
    passed = count - last_count;
    last_count = count;
    return passed;
}

void board_call_on(board_work_t *work, void *argument, void *top) {
    __asm__ volatile("mv s1, sp\n mv sp, %2\n mv a0, %1\n jalr %0\n mv sp, s1"
                     :
                     : "r"(work), "r"(argument), "r"(top)
                     : "ra", "t0", "t1", "t2", "t3", "t4", "t5", "t6", "a0", "a1", "a2", "a3", "a4", "a5", "a6", "a7",
                       "s1", "memory");
}
