/* Cortex-M under an emulator or debugger with semihosting: the command line, and the SysTick timer as a counter of
 * instructions. An emulator that lets each instruction take the same time makes the timer one: how many instructions a tick
 * has is measured at the start, so that the clock of the board does not matter. */
#include "board.h"

#include <stddef.h>

#include "command_line.h"
#include "library_stack.h"

#define SEMIHOSTING_GET_COMMAND_LINE 0x15

#define SYSTICK_MAX UINT32_C(0x00FFFFFF)
#define SYSTICK_ENABLE_CORE_CLOCK UINT32_C(5)
#define CALIBRATION_ROUNDS UINT32_C(1000000)
#define CALIBRATION_INSTRUCTIONS (2 * CALIBRATION_ROUNDS) /* subtract and branch */

typedef struct {
    uint32_t control;
    uint32_t reload;
    uint32_t value; /* counts down; 24 bits */
} systick_t;

static volatile systick_t *const systick = (volatile systick_t *)0xE000E010;
static uint32_t instructions_a_tick;
static uint32_t last_value;

static int32_t semihosting(int32_t operation, void *block) {
    register int32_t r0 __asm__("r0") = operation;
    register void *r1 __asm__("r1") = block;
    __asm__ volatile("bkpt 0xAB" : "+r"(r0) : "r"(r1) : "memory");
    return r0;
}

static uint32_t ticks(void) {
    const uint32_t value = systick->value;
    const uint32_t passed = (last_value - value) & SYSTICK_MAX;

    last_value = value;
    return passed;
}

static void start_counter(void) {
    uint32_t rounds = CALIBRATION_ROUNDS;
    uint32_t passed;

    systick->reload = SYSTICK_MAX;
    systick->value = 0;
    systick->control = SYSTICK_ENABLE_CORE_CLOCK;
    (void)ticks();
    __asm__ volatile("1: subs %0, #1\n bne 1b" : "+l"(rounds) : : "cc");
    passed = ticks();
    /* rounded: the loop takes about 40 000 ticks, so that a tick more or less does not matter */
    instructions_a_tick = passed != 0 ? (CALIBRATION_INSTRUCTIONS + passed / 2) / passed : 0;
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
    start_counter();
}

uint32_t board_instructions(void) {
    return ticks() * instructions_a_tick;
}

void board_call_on(board_work_t *work, void *argument, void *top) {
    __asm__ volatile("mov r4, sp\n mov sp, %2\n mov r0, %1\n blx %0\n mov sp, r4"
                     :
                     : "r"(work), "r"(argument), "r"(top)
                     : "r0", "r1", "r2", "r3", "r4", "r12", "lr", "cc", "memory");
}
