/* Vector table and reset. Plain C: an M-profile core loads the stack pointer itself. */
#include <stdint.h>
#include <stdlib.h>
#include <unistd.h>

#define EXIT_CPU_FAULT 70

typedef void (*vector_t)(void);

/* From the linker script. */
extern uint32_t data_load[], data_start[], data_end[], bss_start[], bss_end[], stack_top[];

void initialise_monitor_handles(void); /* of the C library: opens standard input, output and error */
int main(int count, char *values[]);
void reset(void);

/* A fault ends the emulation instead of spinning in it. */
static void cpu_fault(void) {
    _exit(EXIT_CPU_FAULT);
}

void reset(void) {
    const uint32_t *from = data_load;
    uint32_t *to;

    for (to = data_start; to < data_end; to++)
        *to = *from++;
    for (to = bss_start; to < bss_end; to++)
        *to = 0;
    initialise_monitor_handles();
    exit(main(0, NULL));
}

/* Stack pointer, reset, NMI, hard fault, memory, bus and usage fault, secure fault. No interrupt is enabled. */
static const struct {
    uint32_t *stack;
    vector_t handler[7];
} vectors __attribute__((section(".vectors"), used)) = {
    stack_top, {reset, cpu_fault, cpu_fault, cpu_fault, cpu_fault, cpu_fault, cpu_fault}};
