/* A frame cut into slices gives the same bits as the whole call; instances and frames do not know of each other. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "pose_checks.h"
#include "random_numbers.h"
#include "roadpose/roadpose.h"
#include "synthetic.h"
#include "unity.h"

enum { FRAMES = 12, PIXELS = 640 * 480 };

static roadpose_t one, two;
static uint16_t *images[FRAMES];
static roadpose_pose_t expected[FRAMES];
static roadpose_rig_t rig;
static roadpose_frame_t frames[FRAMES];

/* Roads of all mountings with walls, noise and holes; the last ones are no road at all. */
static void paint(random_numbers_t *numbers, int index, uint16_t *image) {
    const true_pose_t pose = {random_double(numbers, -6, 12), random_double(numbers, -20, 20),
                              random_double(numbers, 0.8, 2.5)};
    render_road(&rig, pose, 256, image);
    for (int wall = 0; wall < 4; wall++) {
        const int from = (int)random_between(numbers, 0, 600);
        render_wall(&rig, pose, random_double(numbers, 4, 30), from, from + 60, 80, image);
    }
    for (int i = 0; i < PIXELS; i++) {
        const double noisy = image[i] + 60 * random_normal(numbers);
        const bool hole = random_between(numbers, 0, 9) == 0 || index == FRAMES - 1;
        if (image[i]) image[i] = (uint16_t)(hole ? 0 : noisy < 1 ? 1 : noisy > 65535 ? 65535 : noisy);
    }
    if (index == FRAMES - 2) random_bytes(numbers, image, 2 * PIXELS);
}

static void init(roadpose_t *instance, const roadpose_settings_t *settings) {
    const roadpose_disparity_format_t format = format_u16_q8();
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_init(instance, &rig, &format, settings));
}

void setUp(void) {
    random_numbers_t numbers = random_numbers("slices");
    rig = rig_640x480();
    init(&one, NULL);
    for (int i = 0; i < FRAMES; i++) {
        images[i] = malloc(2 * PIXELS);
        TEST_ASSERT_NOT_NULL(images[i]);
        paint(&numbers, i, images[i]);
        frames[i] = frame_of(&rig, images[i]);
        TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_process(&one, &frames[i], &expected[i]));
    }
}

void tearDown(void) {
    for (int i = 0; i < FRAMES; i++) free(images[i]);
}

static uint32_t run_slices(roadpose_t *instance, const roadpose_frame_t *frame, roadpose_pose_t *pose) {
    uint32_t slices = 1;
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_frame_begin(instance, frame));
    while (roadpose_frame_slice(instance) == ROADPOSE_MORE) slices++;
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_frame_pose(instance, pose));
    return slices;
}

static void test_some_frames_are_roads_and_some_are_not(void) {
    int roads = 0;
    for (int i = 0; i < FRAMES; i++) roads += expected[i].status == ROADPOSE_STATUS_OK;
    TEST_ASSERT_TRUE(roads >= FRAMES / 2 && roads < FRAMES);
}

static void test_slices_equal_the_whole_call(void) {
    uint32_t most = 0;
    init(&two, NULL);
    for (int i = 0; i < FRAMES; i++) {
        roadpose_pose_t pose;
        const uint32_t slices = run_slices(&two, &frames[i], &pose);
        TEST_ASSERT_TRUE(same_pose(&expected[i], &pose));
        TEST_ASSERT_TRUE(slices <= roadpose_slices_max());
        most = slices > most ? slices : most;
    }
    printf("%u slices at most, bound %u\n", (unsigned)most, (unsigned)roadpose_slices_max());
}

static void test_result_does_not_depend_on_the_frames_before(void) {
    random_numbers_t numbers = random_numbers("frame order");
    init(&two, NULL);
    for (int n = 0; n < 40; n++) {
        const int i = (int)random_between(&numbers, 0, FRAMES - 1);
        roadpose_pose_t pose;
        TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_process(&two, &frames[i], &pose));
        TEST_ASSERT_TRUE(same_pose(&expected[i], &pose));
    }
}

static void test_result_does_not_depend_on_the_memory_before_init(void) {
    for (int fill = 0; fill < 256; fill += 51) {
        roadpose_pose_t pose;
        memset(&two, fill, sizeof two);
        init(&two, NULL);
        TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_process(&two, &frames[fill % FRAMES], &pose));
        TEST_ASSERT_TRUE(same_pose(&expected[fill % FRAMES], &pose));
    }
}

/* Slices of two instances with other settings, taken in turn, must not disturb each other. */
static void test_instances_are_independent(void) {
    roadpose_settings_t settings;
    roadpose_pose_t alone, pose_one, pose_two;
    roadpose_settings_default(&settings);
    settings.method = 1;
    settings.corridor_half_width_mm = 0;
    init(&two, &settings);
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_process(&two, &frames[1], &alone));
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_frame_begin(&one, &frames[0]));
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_frame_begin(&two, &frames[1]));
    roadpose_result_t first = ROADPOSE_MORE, second = ROADPOSE_MORE;
    while (first == ROADPOSE_MORE || second == ROADPOSE_MORE) {
        if (first == ROADPOSE_MORE) first = roadpose_frame_slice(&one);
        if (second == ROADPOSE_MORE) second = roadpose_frame_slice(&two);
    }
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_frame_pose(&one, &pose_one));
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_frame_pose(&two, &pose_two));
    TEST_ASSERT_TRUE(same_pose(&expected[0], &pose_one));
    TEST_ASSERT_TRUE(same_pose(&alone, &pose_two));
}

/* Cancelled after every number of slices that a frame can have. */
static void test_cancel_at_any_slice(void) {
    roadpose_pose_t pose;
    const uint32_t slices = run_slices(&one, &frames[0], &pose);
    for (uint32_t stop = 0; stop < slices; stop += 1 + slices / 60) {
        TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_frame_begin(&one, &frames[0]));
        for (uint32_t i = 0; i < stop; i++) TEST_ASSERT_EQUAL(ROADPOSE_MORE, roadpose_frame_slice(&one));
        TEST_ASSERT_EQUAL(ROADPOSE_ERROR_ORDER, roadpose_frame_pose(&one, &pose));
        TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_frame_cancel(&one));
        TEST_ASSERT_EQUAL(ROADPOSE_ERROR_ORDER, roadpose_frame_slice(&one));
        TEST_ASSERT_EQUAL(ROADPOSE_ERROR_ORDER, roadpose_frame_pose(&one, &pose));
        TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_process(&one, &frames[1], &pose));
        TEST_ASSERT_TRUE(same_pose(&expected[1], &pose));
    }
}

static void test_the_buffer_is_only_read(void) {
    uint16_t *copy = malloc(2 * PIXELS);
    roadpose_pose_t pose;
    TEST_ASSERT_NOT_NULL(copy);
    memcpy(copy, images[0], 2 * PIXELS);
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_process(&one, &frames[0], &pose));
    TEST_ASSERT_EQUAL(0, memcmp(copy, images[0], 2 * PIXELS));
    free(copy);
}

/* After the last slice the buffer may go away: the pose must not need it. */
static void test_pose_stays_when_the_buffer_changes(void) {
    roadpose_pose_t pose;
    (void)run_slices(&one, &frames[0], &pose);
    memset(images[0], 0x11, 2 * PIXELS);
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_frame_pose(&one, &pose));
    TEST_ASSERT_TRUE(same_pose(&expected[0], &pose));
}

static void test_sizes_agree(void) {
    TEST_ASSERT_EQUAL(sizeof(roadpose_t), roadpose_state_bytes());
    TEST_ASSERT_EQUAL(sizeof(roadpose_t), ROADPOSE_STATE_BYTES);
#if ROADPOSE_MAX_WIDTH == 640 && ROADPOSE_ROW_STEP == 2 && ROADPOSE_COLUMN_STEP == 4
    TEST_ASSERT_TRUE(sizeof(roadpose_t) <= 192 * 1024);
#endif
#ifdef ROADPOSE_SMALL_PROFILE
    TEST_ASSERT_TRUE(sizeof(roadpose_t) <= 64 * 1024);
#endif
    printf("one instance: %u bytes\n", (unsigned)sizeof(roadpose_t));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_some_frames_are_roads_and_some_are_not);
    RUN_TEST(test_slices_equal_the_whole_call);
    RUN_TEST(test_result_does_not_depend_on_the_frames_before);
    RUN_TEST(test_result_does_not_depend_on_the_memory_before_init);
    RUN_TEST(test_instances_are_independent);
    RUN_TEST(test_cancel_at_any_slice);
    RUN_TEST(test_the_buffer_is_only_read);
    RUN_TEST(test_pose_stays_when_the_buffer_changes);
    RUN_TEST(test_sizes_agree);
    return UNITY_END();
}
