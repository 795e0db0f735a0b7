/* A frame in slow external memory is read in row slices, at most twice, and only where the sampling grid lies, with all
 * methods, of roads and of anything else, and its confidence image too: every single read of the buffer is trapped and
 * counted. The buffer's pages are closed; a read opens them for one instruction. They are never opened for writing, so a
 * write would end the test. */
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
#define PAGE 4096 /* of this processor */

enum { SAMPLES, CONFIDENCE, IMAGES }; /* one after the other in the buffer */

#if defined(__x86_64__) && defined(__linux__)
#include <ucontext.h>

#define SINGLE_STEP 0x100 /* trap flag of the processor */

static uint8_t *buffer; /* whole pages */
static uint8_t *opened; /* the page of the interrupted read */
static unsigned char reads[IMAGES][HEIGHT][WIDTH];
static unsigned total[IMAGES];
static int last_row[IMAGES];
static unsigned passes[IMAGES];

static void fail_now(const char *text) {
    (void)!write(STDERR_FILENO, text, strlen(text)); /* nothing else is allowed in a signal handler */
    _exit(EXIT_FAILURE);
}

static void count(size_t offset) {
    const size_t image = offset / BYTES;
    const int row = (int)(offset % BYTES / (2 * WIDTH));

    if (image >= IMAGES || offset % 2 != 0)
        fail_now("a read beside the samples\n");
    if (++reads[image][row][offset / 2 % WIDTH] > READS_LIMIT)
        fail_now("a sample is read for ever, or written\n");
    passes[image] += (row < last_row[image] || passes[image] == 0) ? 1u : 0u;
    last_row[image] = row;
    total[image]++;
}

static void on_read(int number, siginfo_t *info, void *context) {
    ucontext_t *interrupted = context;

    (void)number;
    count((size_t)((uint8_t *)info->si_addr - buffer));
    opened = buffer + ((uint8_t *)info->si_addr - buffer) / PAGE * PAGE; /* an even address: the sample ends on the page */
    if (mprotect(opened, PAGE, PROT_READ) != 0)
        fail_now("mprotect\n");
    interrupted->uc_mcontext.gregs[REG_EFL] |= SINGLE_STEP;
}

static void after_read(int number, siginfo_t *info, void *context) {
    ucontext_t *interrupted = context;

    (void)number;
    (void)info;
    if (mprotect(opened, PAGE, PROT_NONE) != 0)
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

static void open_buffer(void) {
    if (buffer == NULL)
        buffer = mmap(NULL, IMAGES * BYTES, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    TEST_ASSERT_TRUE(buffer != MAP_FAILED);
    TEST_ASSERT_EQUAL_INT(0, mprotect(buffer, IMAGES * BYTES, PROT_READ | PROT_WRITE));
    memset(buffer, 0, BYTES);
    memset(buffer + BYTES, 0xff, BYTES); /* all of it confident */
    memset(reads, 0, sizeof reads);
    memset(total, 0, sizeof total);
    memset(passes, 0, sizeof passes);
}

static void close_buffer(void) {
    TEST_ASSERT_EQUAL_INT(0, mprotect(buffer, IMAGES * BYTES, PROT_NONE));
    trap(SIGSEGV, on_read);
    trap(SIGTRAP, after_read);
}

static void paint_road(void) {
    const roadpose_rig_t rig = rig_640x480();
    const true_pose_t pose = {3.0, 4.0, 1.4};

    open_buffer();
    render_road(&rig, pose, ROADPOSE_MAX_DISPARITY, (uint16_t *)(void *)buffer);
    close_buffer();
}

static void paint_noise(void) {
    uint32_t random = 1;
    size_t i;

    open_buffer();
    for (i = 0; i < BYTES; i++) {
        random = random * UINT32_C(1664525) + UINT32_C(1013904223);
        buffer[i] = (uint8_t)(random >> 24);
    }
    close_buffer();
}

static void paint_nothing(void) {
    open_buffer();
    close_buffer();
}

static void process_in_slices(roadpose_t *instance) {
    roadpose_result_t result = ROADPOSE_MORE;

    while (result == ROADPOSE_MORE) {
        const unsigned before = total[SAMPLES];

        result = roadpose_frame_slice(instance);
        TEST_ASSERT_LESS_OR_EQUAL_UINT(ROADPOSE_SLICE_SAMPLES, total[SAMPLES] - before);
    }
    TEST_ASSERT_EQUAL_INT(ROADPOSE_OK, result);
}

static uint8_t process(const roadpose_settings_t *settings, bool has_confidence) {
    static roadpose_t instance;
    const roadpose_rig_t rig = rig_640x480();
    roadpose_disparity_format_t format = format_u16_q8();
    roadpose_frame_t frame = frame_of(&rig, buffer);
    roadpose_pose_t pose;

    format.has_confidence_image = has_confidence;
    format.confidence_min = has_confidence ? 100 : 0;
    frame.confidence = has_confidence ? buffer + BYTES : NULL;
    frame.confidence_stride_bytes = has_confidence ? 2 * WIDTH : 0;
    TEST_ASSERT_EQUAL_INT(ROADPOSE_OK, roadpose_init(&instance, &rig, &format, settings));
    TEST_ASSERT_EQUAL_INT(ROADPOSE_OK, roadpose_frame_begin(&instance, &frame));
    process_in_slices(&instance);
    TEST_ASSERT_EQUAL_INT(ROADPOSE_OK, roadpose_frame_pose(&instance, &pose));
    return pose.status;
}

/* Reads lie on the grid, in at most two passes from the first row to the last. */
static void check_reads(int image, unsigned at_least) {
    int row, column;

    TEST_ASSERT_LESS_OR_EQUAL_UINT(2, passes[image]);
    TEST_ASSERT_LESS_OR_EQUAL_UINT(2 * GRID_SAMPLES, total[image]);
    TEST_ASSERT_GREATER_OR_EQUAL_UINT(at_least * GRID_SAMPLES, total[image]);
    for (row = 0; row < HEIGHT; row++)
        for (column = 0; column < WIDTH; column++) {
            const bool is_on_grid = row % ROADPOSE_ROW_STEP == 0 && column % ROADPOSE_COLUMN_STEP == 0;
            TEST_ASSERT_LESS_OR_EQUAL_UINT8(is_on_grid ? 2 : 0, reads[image][row][column]);
            TEST_ASSERT_GREATER_OR_EQUAL_UINT8(is_on_grid ? at_least : 0, reads[image][row][column]);
        }
}

static void each_sample_of_a_road_is_read_twice_and_no_other_at_all(void) {
    paint_road();
    TEST_ASSERT_EQUAL_UINT8(ROADPOSE_STATUS_OK, process(NULL, false));
    check_reads(SAMPLES, 2);
    TEST_ASSERT_EQUAL_UINT(0, total[CONFIDENCE]);
}

static void no_method_and_no_content_takes_more(void) {
    static void (*const paint[])(void) = {paint_road, paint_noise, paint_nothing};
    roadpose_settings_t settings;
    unsigned content, variant;

    roadpose_settings_default(&settings);
    for (variant = 0; variant < 3; variant++)
        for (content = 0; content < sizeof paint / sizeof paint[0]; content++) {
            settings.method = variant == 0 ? 2 : 1;
            settings.refine = variant == 1;
            paint[content]();
            (void)process(&settings, false);
            check_reads(SAMPLES, 1);
        }
}

static void the_confidence_image_is_read_no_more_often(void) {
    paint_road();
    TEST_ASSERT_EQUAL_UINT8(ROADPOSE_STATUS_OK, process(NULL, true));
    check_reads(SAMPLES, 1);
    check_reads(CONFIDENCE, 1);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(each_sample_of_a_road_is_read_twice_and_no_other_at_all);
    RUN_TEST(no_method_and_no_content_takes_more);
    RUN_TEST(the_confidence_image_is_read_no_more_often);
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
