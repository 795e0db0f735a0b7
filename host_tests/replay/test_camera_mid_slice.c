/* The camera port against an interrupt in the middle of a slice: each row of the frame in work lies on a memory page of
 * its own that may not be read; the slice that reads it faults, and the fault is the interrupt. */
#define _DEFAULT_SOURCE /* MAP_ANONYMOUS */

#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "camera_driver.h"
#include "unity.h"

static roadpose_camera_context_t driver;
static uint8_t *rows; /* a page each */
static size_t page;
static size_t open_row; /* the one that may be read; DRIVER_HEIGHT: none */
static uint32_t point, strike;
static unsigned interrupts;
static char current[96]; /* what a failure prints */

static void on_fault(int signal_number, siginfo_t *info, void *context) {
    const uintptr_t offset = (uintptr_t)info->si_addr - (uintptr_t)rows;
    const size_t row = offset / page;

    (void)context;
    if (row >= DRIVER_HEIGHT) {
        (void)signal(signal_number, SIG_DFL); /* not ours: a crash, on return */
        return;
    }
    if (open_row < DRIVER_HEIGHT)
        (void)mprotect(rows + open_row * page, page, PROT_NONE);
    (void)mprotect(rows + row * page, page, PROT_READ);
    open_row = row;
    if (point++ == strike)
        for (unsigned i = 0; i < interrupts; i++)
            driver_interrupt(&driver, FRAME_GOOD);
}

void setUp(void) {
    struct sigaction action;

    page = (size_t)sysconf(_SC_PAGESIZE);
    rows = mmap(NULL, DRIVER_HEIGHT * page, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    TEST_ASSERT_TRUE(rows != MAP_FAILED);
    memset(&action, 0, sizeof action);
    action.sa_sigaction = on_fault;
    action.sa_flags = SA_SIGINFO | SA_NODEFER; /* a failed assertion jumps out of it */
    TEST_ASSERT_EQUAL_INT(0, sigaction(SIGSEGV, &action, NULL));
    TEST_ASSERT_EQUAL_INT(0, sigaction(SIGBUS, &action, NULL));
}

void tearDown(void) {
    if (Unity.CurrentTestFailed)
        (void)printf("\nin the run with %s\n", current);
    (void)munmap(rows, DRIVER_HEIGHT * page);
}

static void draw_rows(uint32_t frame) {
    uint16_t samples[DRIVER_HEIGHT][DRIVER_WIDTH];

    driver_draw(&samples[0][0], frame);
    TEST_ASSERT_EQUAL_INT(0, mprotect(rows, DRIVER_HEIGHT * page, PROT_READ | PROT_WRITE));
    for (size_t row = 0; row < DRIVER_HEIGHT; row++)
        memcpy(rows + row * page, samples[row], sizeof samples[row]);
    TEST_ASSERT_EQUAL_INT(0, mprotect(rows, DRIVER_HEIGHT * page, PROT_NONE));
    open_row = DRIVER_HEIGHT;
}

/* Frame 0 lies on the pages; the ledger takes it as one without a buffer of the driver. */
static void hand_over_rows(void) {
    const roadpose_frame_t frame = {rows, (uint32_t)page, DRIVER_WIDTH, DRIVER_HEIGHT, NULL, 0};

    draw_rows(0);
    driver.next_frame = 1;
    driver.owner[0] = OWNER_PORT;
    driver.buffer[0] = DRIVER_BUFFERS - 1;
    driver.kind[0] = FRAME_WITHOUT_SAMPLES;
    TEST_ASSERT_TRUE(roadpose_camera_frame_ready(&driver.port, &frame, 0, UINT64_C(5000000000)));
}

/* One run; the driver checks every pose, buffer and counter. Returns how often a row was begun in a slice. */
static uint32_t run(uint32_t strike_at, unsigned interrupts_there, uint32_t slices) {
    (void)snprintf(current, sizeof current, "%u interrupts at point %lu, %lu slices a cycle", interrupts_there,
                   (unsigned long)strike_at, (unsigned long)slices);
    driver_start(&driver);
    point = 0;
    strike = strike_at;
    interrupts = interrupts_there;
    hand_over_rows();
    while (roadpose_camera_task(&driver.port, slices) != ROADPOSE_CAMERA_IDLE)
        continue;
    if (strike_at < point) { /* the frame in work was not disturbed, the newest one came after it */
        TEST_ASSERT_EQUAL_UINT32(2, driver.poses);
        TEST_ASSERT_EQUAL_UINT32(interrupts_there, driver.last_pose_frame);
    }
    driver_stop(&driver);
    return point;
}

static void strike_everywhere(unsigned interrupts_there, uint32_t slices) {
    uint32_t first = 0;

    while (first < run(first, interrupts_there, slices))
        first++;
    TEST_ASSERT_TRUE_MESSAGE(first >= DRIVER_HEIGHT / 2, "hardly any row was read");
}

static void test_a_frame_arrives_in_the_middle_of_a_slice(void) {
    strike_everywhere(1, 1);
    strike_everywhere(1, UINT32_MAX);
}

static void test_the_mailbox_is_overwritten_in_the_middle_of_a_slice(void) {
    strike_everywhere(2, 1);
    strike_everywhere(5, UINT32_MAX);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_a_frame_arrives_in_the_middle_of_a_slice);
    RUN_TEST(test_the_mailbox_is_overwritten_in_the_middle_of_a_slice);
    return UNITY_END();
}
