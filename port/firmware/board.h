/* What a board supplies to the firmware main: where its objects lie, how it starts, and how it counts instructions.
 * One file a board: port/cortex_m/board.c, port/riscv/board.c, port/firmware/hosted_board.c. */
#ifndef ROADPOSE_BOARD_H
#define ROADPOSE_BOARD_H

#include <stdint.h>

/* Memory of the library (state and ports), as large as the product gives it; and the memory that the camera's DMA
 * writes to. Where the board's linker script does not tell them apart, both are ordinary memory. */
#ifdef ROADPOSE_BOARD_SECTIONS
#define BOARD_LIBRARY_RAM __attribute__((section(".library_ram")))
#define BOARD_EXTERNAL_RAM __attribute__((section(".external_ram")))
#else
#define BOARD_LIBRARY_RAM
#define BOARD_EXTERNAL_RAM
#endif

/* The stack that a product gives the library (docs/budgets.md). Unoptimised code takes more; nobody ships it. */
#ifdef __OPTIMIZE__
#define BOARD_LIBRARY_STACK_BYTES 1024
#else
#define BOARD_LIBRARY_STACK_BYTES 3072
#endif

#define BOARD_ARGUMENTS_MAX 10

typedef struct {
    int count;
    char *values[BOARD_ARGUMENTS_MAX];
} board_arguments_t;

/* Starts the counter. count, values: what main() got. Fills *arguments, on bare metal from the command line that the
 * debugger or emulator gives; values[0] is the program. */
void board_start(board_arguments_t *arguments, int count, char *const values[]);

/* Executed instructions since the last call, the call's own included; 0 where the board cannot count them. True only
 * where every instruction takes the same time, as in an emulator that counts them. Call it at least once in 100
 * million instructions. */
uint32_t board_instructions(void);

typedef void board_work_t(void *argument);

/* Calls work(argument) on the library's own stack of BOARD_LIBRARY_STACK_BYTES, which lies in BOARD_LIBRARY_RAM; on a hosted
 * machine on the caller's. Whatever reads files or prints needs more and must not be called in it. */
void board_call(board_work_t *work, void *argument);

/* How many bytes of that stack were ever in use; 0 on a hosted machine. */
uint32_t board_stack_used(void);

#endif
