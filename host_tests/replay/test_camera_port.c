/* The camera port call by call: hand-over, displacement, refusal, slices, flush, counters. */
#include <string.h>

#include "camera_driver.h"
#include "unity.h"

static roadpose_camera_context_t driver;

void setUp(void) {
    driver_start(&driver);
}

void tearDown(void) {
}

static roadpose_camera_counters_t counters(void) {
    roadpose_camera_counters_t read;

    memset(&read, 0x77, sizeof read);
    roadpose_camera_read_counters(&driver.port, &read);
    return read;
}

static roadpose_camera_progress_t work_off(void) {
    return roadpose_camera_task(&driver.port, UINT32_MAX);
}

static void test_init_refuses_what_is_missing(void) {
    const roadpose_camera_platform_t whole = driver_platform(&driver);
    roadpose_camera_port_t port, before;

    memset(&port, 0x31, sizeof port);
    before = port;
    for (int missing = 0; missing < 7; missing++) {
        roadpose_camera_platform_t part = whole;

        part.frame_release = missing == 0 ? NULL : part.frame_release;
        part.pose_ready = missing == 1 ? NULL : part.pose_ready;
        part.lock = missing == 2 ? NULL : part.lock;
        part.unlock = missing == 3 ? NULL : part.unlock;
        TEST_ASSERT_EQUAL_INT(ROADPOSE_ERROR_NULL,
                              roadpose_camera_init(missing == 4 ? NULL : &port, missing == 5 ? NULL : &part,
                                                   missing == 6 ? NULL : &driver.estimator));
        TEST_ASSERT_EQUAL_MEMORY(&before, &port, sizeof port);
    }
}

static void test_a_port_that_is_not_initialised_does_nothing(void) {
    const roadpose_frame_t frame = {driver.buffers[0], 2 * DRIVER_WIDTH, DRIVER_WIDTH, DRIVER_HEIGHT, NULL, 0};
    roadpose_camera_counters_t read, before;
    roadpose_camera_port_t port;

    memset(&port, 0, sizeof port);
    memset(&read, 0x77, sizeof read);
    before = read;
    TEST_ASSERT_FALSE(roadpose_camera_frame_ready(&port, &frame, 0, 0));
    TEST_ASSERT_FALSE(roadpose_camera_frame_ready(NULL, &frame, 0, 0));
    TEST_ASSERT_FALSE(roadpose_camera_frame_ready(&driver.port, NULL, 0, 0));
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAMERA_IDLE, roadpose_camera_task(&port, 1));
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAMERA_IDLE, roadpose_camera_task(NULL, 1));
    roadpose_camera_flush(&port);
    roadpose_camera_flush(NULL);
    roadpose_camera_read_counters(&port, &read);
    roadpose_camera_read_counters(NULL, &read);
    roadpose_camera_read_counters(&driver.port, NULL);
    TEST_ASSERT_EQUAL_MEMORY(&before, &read, sizeof read);
}

static void test_idle_without_a_frame(void) {
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAMERA_IDLE, work_off());
    TEST_ASSERT_EQUAL_UINT32(0, counters().frames_ready);
    TEST_ASSERT_EQUAL_INT(ROADPOSE_OK, counters().last_refusal);
    driver_stop(&driver);
}

static void test_one_frame_in_one_call(void) {
    driver_interrupt(&driver, FRAME_GOOD);
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAMERA_FINISHED, work_off());
    TEST_ASSERT_EQUAL_UINT32(1, driver.poses);
    TEST_ASSERT_EQUAL_INT(OWNER_DRIVER_AGAIN, driver.owner[0]);
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAMERA_IDLE, work_off());
    driver_stop(&driver);
}

static void test_the_interrupt_does_no_work(void) {
    driver_interrupt(&driver, FRAME_GOOD);
    TEST_ASSERT_EQUAL_UINT32(0, driver.invalidations);
    TEST_ASSERT_EQUAL_INT(ROADPOSE_ERROR_ORDER, roadpose_frame_slice(&driver.estimator)); /* nothing begun */
    driver_stop(&driver);
}

static void test_slices_are_counted_out(void) {
    uint32_t calls = 1;

    driver_interrupt(&driver, FRAME_GOOD);
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAMERA_WORKING, roadpose_camera_task(&driver.port, 0));
    while (roadpose_camera_task(&driver.port, 1) == ROADPOSE_CAMERA_WORKING)
        calls++;
    TEST_ASSERT_TRUE(calls > 1 && calls <= roadpose_slices_max());
    TEST_ASSERT_EQUAL_UINT32(1, driver.poses);
    driver_interrupt(&driver, FRAME_GOOD);
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAMERA_WORKING, roadpose_camera_task(&driver.port, calls - 1));
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAMERA_FINISHED, roadpose_camera_task(&driver.port, 1));
    driver_stop(&driver);
}

static void test_the_newest_frame_wins(void) {
    for (int i = 0; i < 5; i++)
        driver_interrupt(&driver, FRAME_GOOD);
    TEST_ASSERT_EQUAL_UINT32(4, counters().frames_displaced);
    for (int i = 0; i < 4; i++)
        TEST_ASSERT_EQUAL_INT(OWNER_DRIVER_AGAIN, driver.owner[i]);
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAMERA_FINISHED, work_off());
    TEST_ASSERT_EQUAL_UINT32(4, driver.last_pose_frame);
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAMERA_IDLE, work_off());
    driver_stop(&driver);
}

static void test_a_frame_in_work_is_not_displaced(void) {
    driver_interrupt(&driver, FRAME_GOOD);
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAMERA_WORKING, roadpose_camera_task(&driver.port, 1));
    driver_interrupt(&driver, FRAME_GOOD);
    driver_interrupt(&driver, FRAME_GOOD);
    TEST_ASSERT_EQUAL_INT(OWNER_PORT, driver.owner[0]);
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAMERA_FINISHED, work_off());
    TEST_ASSERT_EQUAL_UINT32(0, driver.last_pose_frame);
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAMERA_FINISHED, work_off());
    TEST_ASSERT_EQUAL_UINT32(2, driver.last_pose_frame);
    TEST_ASSERT_EQUAL_UINT32(1, counters().frames_displaced);
    driver_stop(&driver);
}

static void assert_refused(frame_kind_t kind, roadpose_result_t reason) {
    const uint32_t refused = counters().frames_refused;

    driver_interrupt(&driver, kind);
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAMERA_REFUSED, work_off());
    TEST_ASSERT_EQUAL_UINT32(refused + 1, counters().frames_refused);
    TEST_ASSERT_EQUAL_INT(reason, counters().last_refusal);
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAMERA_IDLE, work_off());
    driver_interrupt(&driver, FRAME_GOOD); /* not stuck */
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAMERA_FINISHED, work_off());
}

static void test_frames_that_do_not_fit_are_refused(void) {
    assert_refused(FRAME_WRONG_SIZE, ROADPOSE_ERROR_SIZE);
    assert_refused(FRAME_SHORT_STRIDE, ROADPOSE_ERROR_STRIDE);
    assert_refused(FRAME_WITHOUT_SAMPLES, ROADPOSE_ERROR_NULL);
    TEST_ASSERT_EQUAL_UINT32(3, driver.invalidations); /* of the good frames only */
    driver_stop(&driver);
}

static void test_an_estimator_that_lost_its_frame(void) {
    driver_interrupt(&driver, FRAME_GOOD);
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAMERA_WORKING, roadpose_camera_task(&driver.port, 1));
    TEST_ASSERT_EQUAL_INT(ROADPOSE_OK, roadpose_frame_cancel(&driver.estimator));
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAMERA_REFUSED, roadpose_camera_task(&driver.port, 1));
    TEST_ASSERT_EQUAL_INT(ROADPOSE_ERROR_ORDER, counters().last_refusal);
    driver_interrupt(&driver, FRAME_GOOD);
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAMERA_FINISHED, work_off());
    driver_stop(&driver);
}

static void test_an_estimator_that_works_on_another_frame(void) {
    const roadpose_frame_t foreign = {driver.buffers[2], 2 * DRIVER_WIDTH, DRIVER_WIDTH, DRIVER_HEIGHT, NULL, 0};

    TEST_ASSERT_EQUAL_INT(ROADPOSE_OK, roadpose_frame_begin(&driver.estimator, &foreign));
    driver_interrupt(&driver, FRAME_GOOD);
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAMERA_REFUSED, work_off());
    TEST_ASSERT_EQUAL_INT(ROADPOSE_ERROR_ORDER, counters().last_refusal);
    driver_stop(&driver);
}

static void test_the_cache_is_invalidated_once_before_the_first_slice(void) {
    driver_interrupt(&driver, FRAME_GOOD);
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAMERA_WORKING, roadpose_camera_task(&driver.port, 0));
    TEST_ASSERT_EQUAL_UINT32(1, driver.invalidations);
    TEST_ASSERT_EQUAL_PTR(driver.buffers[0], driver.invalidated[0]);
    TEST_ASSERT_EQUAL_UINT32(2 * DRIVER_SAMPLES, driver.invalidated_bytes[0]);
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAMERA_FINISHED, work_off());
    TEST_ASSERT_EQUAL_UINT32(1, driver.invalidations);
    driver_stop(&driver);
}

static void test_the_cache_of_the_confidence_image_is_invalidated_too(void) {
    static uint16_t confidence[DRIVER_HEIGHT * (DRIVER_WIDTH + 5)];
    const roadpose_frame_t frame = {driver.buffers[1], 2 * DRIVER_WIDTH, DRIVER_WIDTH,
                                    DRIVER_HEIGHT,     confidence,       2 * (DRIVER_WIDTH + 5)};
    const roadpose_rig_t rig = {DRIVER_WIDTH, DRIVER_HEIGHT, 60000, 31500, 31500, 300000};
    roadpose_disparity_format_t format;

    TEST_ASSERT_TRUE(roadpose_format_preset(&format, ROADPOSE_FORMAT_VPI));
    TEST_ASSERT_EQUAL_INT(ROADPOSE_OK, roadpose_init(&driver.estimator, &rig, &format, NULL));
    TEST_ASSERT_TRUE(roadpose_camera_frame_ready(&driver.port, &frame, 0, 0));
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAMERA_WORKING, roadpose_camera_task(&driver.port, 0));
    TEST_ASSERT_EQUAL_UINT32(2, driver.invalidations);
    TEST_ASSERT_EQUAL_PTR(driver.buffers[1], driver.invalidated[0]);
    TEST_ASSERT_EQUAL_PTR(confidence, driver.invalidated[1]);
    TEST_ASSERT_EQUAL_UINT32(2 * ((DRIVER_HEIGHT - 1) * (DRIVER_WIDTH + 5) + DRIVER_WIDTH),
                             driver.invalidated_bytes[1]);
}

/* Its pointer and stride are checked by nobody. */
static void test_the_cache_of_a_confidence_image_that_is_not_used_is_left_alone(void) {
    const roadpose_frame_t frame = {driver.buffers[1], 2 * DRIVER_WIDTH, DRIVER_WIDTH,
                                    DRIVER_HEIGHT,     &driver,          UINT32_MAX};

    TEST_ASSERT_TRUE(roadpose_camera_frame_ready(&driver.port, &frame, 0, 0));
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAMERA_WORKING, roadpose_camera_task(&driver.port, 1));
    TEST_ASSERT_EQUAL_UINT32(1, driver.invalidations);
    TEST_ASSERT_EQUAL_PTR(driver.buffers[1], driver.invalidated[0]);
}

static void test_optional_callbacks_may_be_absent(void) {
    roadpose_camera_platform_t platform = driver_platform(&driver);

    platform.lock = NULL;
    platform.unlock = NULL;
    platform.cache_invalidate = NULL;
    TEST_ASSERT_EQUAL_INT(ROADPOSE_OK, roadpose_camera_init(&driver.port, &platform, &driver.estimator));
    driver_interrupt(&driver, FRAME_GOOD);
    driver_interrupt(&driver, FRAME_GOOD);
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAMERA_FINISHED, work_off());
    TEST_ASSERT_EQUAL_UINT32(0, driver.invalidations);
    driver_stop(&driver);
}

static void test_flush_gives_everything_back(void) {
    roadpose_camera_flush(&driver.port);
    TEST_ASSERT_EQUAL_UINT32(0, counters().frames_flushed);
    driver_interrupt(&driver, FRAME_GOOD);
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAMERA_WORKING, roadpose_camera_task(&driver.port, 1));
    driver_interrupt(&driver, FRAME_GOOD);
    roadpose_camera_flush(&driver.port);
    TEST_ASSERT_EQUAL_INT(OWNER_DRIVER_AGAIN, driver.owner[0]);
    TEST_ASSERT_EQUAL_INT(OWNER_DRIVER_AGAIN, driver.owner[1]);
    TEST_ASSERT_EQUAL_UINT32(2, counters().frames_flushed);
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAMERA_IDLE, work_off());
    driver_interrupt(&driver, FRAME_GOOD); /* and the estimator is free */
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAMERA_FINISHED, work_off());
    driver_stop(&driver);
}

/* Else a mixed-up pose would not show. */
static void test_the_scenes_differ(void) {
    for (uint32_t scene = 0; scene < DRIVER_SCENES; scene++)
        TEST_ASSERT_TRUE(driver_expected_pose(scene).valid_samples != driver_expected_pose(scene + 1).valid_samples);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_init_refuses_what_is_missing);
    RUN_TEST(test_a_port_that_is_not_initialised_does_nothing);
    RUN_TEST(test_idle_without_a_frame);
    RUN_TEST(test_one_frame_in_one_call);
    RUN_TEST(test_the_interrupt_does_no_work);
    RUN_TEST(test_slices_are_counted_out);
    RUN_TEST(test_the_newest_frame_wins);
    RUN_TEST(test_a_frame_in_work_is_not_displaced);
    RUN_TEST(test_frames_that_do_not_fit_are_refused);
    RUN_TEST(test_an_estimator_that_lost_its_frame);
    RUN_TEST(test_an_estimator_that_works_on_another_frame);
    RUN_TEST(test_the_cache_is_invalidated_once_before_the_first_slice);
    RUN_TEST(test_the_cache_of_the_confidence_image_is_invalidated_too);
    RUN_TEST(test_the_cache_of_a_confidence_image_that_is_not_used_is_left_alone);
    RUN_TEST(test_optional_callbacks_may_be_absent);
    RUN_TEST(test_flush_gives_everything_back);
    RUN_TEST(test_the_scenes_differ);
    return UNITY_END();
}
