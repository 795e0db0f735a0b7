/* A frame in slow external memory is read in row slices, at most twice, and only where the sampling grid lies: every
 * single read of the buffer is trapped and counted. The buffer's pages are closed; a read opens them for one
 * instruction. They are never opened for writing, so a write would end the test. */
#define _GNU_SOURCE /* registers of an interrupted instruction */
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "roadpose/roadpose.h"
#include "synthetic.h"
#include "unity.h"

#define EXIT_SKIPPED 77
#define WIDTH 640
#define HEIGHT 480
#define BYTES (2 * WIDTH * HEIGHT)
#define GRID_SAMPLES (ROADPOSE_MAX_GRID_ROWS * ROADPOSE_MAX_GRID_COLUMNS)
#define READS_LIMIT 100

#if defined(__x86_64__) && defined(__linux__)
#include <ucontext.h>

#define SINGLE_STEP 0x100 /* trap flag of the processor */

static uint8_t *buffer; /* whole pages */
static unsigned char reads[HEIGHT][WIDTH];
static unsigned total;
static int last_row;
static unsigned passes;

static void fail_now(const char *text) {
    (void)!write(STDERR_FILENO, text, strlen(text)); /* nothing else is allowed in a signal handler */
    _exit(EXIT_FAILURE);
}

static void count(size_t offset) {
    const int row = (int)(offset / (2 * WIDTH));

    if (offset >= BYTES || offset % 2 != 0)
        fail_now("a read beside the samples\n");
    if (++reads[row][offset / 2 % WIDTH] > READS_LIMIT)
        fail_now("a sample is read for ever, or written\n");
    passes += (row < last_row || passes == 0) ? 1u : 0u;
    last_row = row;
    total++;
}

static void on_read(int number, siginfo_t *info, void *context) {
    ucontext_t *interrupted = context;

    (void)number;
    count((size_t)((uint8_t *)info->si_addr - buffer));
    if (mprotect(buffer, BYTES, PROT_READ) != 0)
        fail_now("mprotect\n");
    interrupted->uc_mcontext.gregs[REG_EFL] |= SINGLE_STEP;
}

static void after_read(int number, siginfo_t *info, void *context) {
    ucontext_t *interrupted = context;

    (void)number;
    (void)info;
    if (mprotect(buffer, BYTES, PROT_NONE) != 0)
        fail_now("mprotect\n");
    interrupted->uc_mcontext.gregs[REG_EFL] &= ~(greg_t)SINGLE_STEP;
}

static void trap(int number, void (*handler)(int, siginfo_t *, void *)) {
    struct sigaction action;

    memset(&action, 0, sizeof action);
    action.sa_sigaction = handler;
    action.sa_flags = SA_SIGINFO;
    TEST_ASSERT_EQUAL_INT(0, sigaction(number, &action, NULL));
}

static void close_buffer(void) {
    const roadpose_rig_t rig = rig_640x480();
    const true_pose_t pose = {3.0, 4.0, 1.4};

    buffer = mmap(NULL, BYTES, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    TEST_ASSERT_TRUE(buffer != MAP_FAILED);
    render_road(&rig, pose, ROADPOSE_MAX_DISPARITY, (uint16_t *)(void *)buffer);
    TEST_ASSERT_EQUAL_INT(0, mprotect(buffer, BYTES, PROT_NONE));
    trap(SIGSEGV, on_read);
    trap(SIGTRAP, after_read);
}

static void process_in_slices(roadpose_t *instance) {
    roadpose_result_t result = ROADPOSE_MORE;

    while (result == ROADPOSE_MORE) {
        const unsigned before = total;

        result = roadpose_frame_slice(instance);
        TEST_ASSERT_LESS_OR_EQUAL_UINT(ROADPOSE_SLICE_SAMPLES, total - before);
    }
    TEST_ASSERT_EQUAL_INT(ROADPOSE_OK, result);
}

static void each_sample_of_the_grid_is_read_twice_and_no_other_at_all(void) {
    static roadpose_t instance;
    const roadpose_rig_t rig = rig_640x480();
    const roadpose_disparity_format_t format = format_u16_q8();
    roadpose_pose_t pose;

    close_buffer();
    const roadpose_frame_t frame = frame_of(&rig, buffer);
    TEST_ASSERT_EQUAL_INT(ROADPOSE_OK, roadpose_init(&instance, &rig, &format, NULL));
    TEST_ASSERT_EQUAL_INT(ROADPOSE_OK, roadpose_frame_begin(&instance, &frame));
    process_in_slices(&instance);
    TEST_ASSERT_EQUAL_INT(ROADPOSE_OK, roadpose_frame_pose(&instance, &pose));
    TEST_ASSERT_EQUAL_UINT8(ROADPOSE_STATUS_OK, pose.status);
    TEST_ASSERT_EQUAL_UINT(2, passes);
    TEST_ASSERT_EQUAL_UINT(2 * GRID_SAMPLES, total);
    for (int row = 0; row < HEIGHT; row++)
        for (int column = 0; column < WIDTH; column++) {
            const bool is_on_grid = row % ROADPOSE_ROW_STEP == 0 && column % ROADPOSE_COLUMN_STEP == 0;
            TEST_ASSERT_EQUAL_UINT8(is_on_grid ? 2 : 0, reads[row][column]);
        }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(each_sample_of_the_grid_is_read_twice_and_no_other_at_all);
    return UNITY_END();
}
#else
int main(void) {
    return EXIT_SKIPPED; /* reads are trapped by means of this processor */
}
#endif

void setUp(void) {
}

void tearDown(void) {
}
