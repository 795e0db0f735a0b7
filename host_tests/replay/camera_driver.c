#include "camera_driver.h"

#include <stdio.h>
#include <string.h>

#include "unity.h"

static const roadpose_rig_t rig = {DRIVER_WIDTH, DRIVER_HEIGHT, 60000, 31500, 31500, 300000};

/* A level road; each scene sees it from another row on, which shows in the support figures whatever the pose. */
void driver_draw(uint16_t *samples, uint32_t frame) {
    const int first_row = 36 + 6 * (int)(frame % DRIVER_SCENES);

    for (int row = 0; row < DRIVER_HEIGHT; row++)
        for (int column = 0; column < DRIVER_WIDTH; column++)
            *samples++ = row >= first_row ? (uint16_t)(20 * (2 * row - 63)) : 0;
}

static void start_estimator(roadpose_t *estimator) {
    roadpose_disparity_format_t format;

    TEST_ASSERT_TRUE(roadpose_format_preset(&format, ROADPOSE_FORMAT_U16_Q8));
    TEST_ASSERT_EQUAL_INT(ROADPOSE_OK, roadpose_init(estimator, &rig, &format, NULL));
}

roadpose_pose_t driver_expected_pose(uint32_t frame) {
    static roadpose_pose_t poses[DRIVER_SCENES];
    static bool is_known[DRIVER_SCENES];
    static roadpose_t estimator;
    static uint16_t samples[DRIVER_SAMPLES];
    const uint32_t scene = frame % DRIVER_SCENES;
    const roadpose_frame_t whole = {samples, 2 * DRIVER_WIDTH, DRIVER_WIDTH, DRIVER_HEIGHT, NULL, 0};

    if (!is_known[scene]) {
        driver_draw(samples, scene);
        start_estimator(&estimator);
        TEST_ASSERT_EQUAL_INT(ROADPOSE_OK, roadpose_process(&estimator, &whole, &poses[scene]));
        is_known[scene] = true;
    }
    return poses[scene];
}

void driver_pass_point(roadpose_camera_context_t *driver) {
    const uint32_t point = driver->point;

    if (driver->is_in_interrupt || driver->lock_depth > 0) /* masked */
        return;
    driver->point++;
    if (point == driver->strike[0] || point == driver->strike[1])
        driver_interrupt(driver, driver->strike_kind);
}

/* Turns over, and back, every bit that both sides share: who looks at it or changes it without the lock goes wrong. */
static void turn_shared(roadpose_camera_port_t *port) {
    uint8_t *const bytes = (uint8_t *)&port->mailbox;

    for (size_t i = 0; i < sizeof port->mailbox; i++)
        bytes[i] = (uint8_t)~bytes[i];
    port->is_full = !port->is_full;
    port->counters.frames_ready = ~port->counters.frames_ready;
    port->counters.frames_displaced = ~port->counters.frames_displaced;
}

static uint32_t lock(roadpose_camera_context_t *driver) {
    driver_pass_point(driver);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, driver->lock_depth, "the port locks twice");
    driver->lock_depth++;
    turn_shared(&driver->port);
    return 0xCAFEu + (driver->is_in_interrupt ? 1u : 0u);
}

static void unlock(roadpose_camera_context_t *driver, uint32_t state) {
    TEST_ASSERT_EQUAL_INT_MESSAGE(1, driver->lock_depth, "unlock without lock");
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(0xCAFEu + (driver->is_in_interrupt ? 1u : 0u), state, "not what lock returned");
    turn_shared(&driver->port);
    driver->lock_depth--;
    driver_pass_point(driver);
}

static void frame_release(roadpose_camera_context_t *driver, const roadpose_frame_t *frame, uint32_t frame_id) {
    driver_pass_point(driver);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, driver->lock_depth, "released with the lock held");
    TEST_ASSERT_TRUE_MESSAGE(frame_id < DRIVER_FRAMES, "released a frame that never was");
    TEST_ASSERT_EQUAL_INT_MESSAGE(OWNER_PORT, driver->owner[frame_id], "released a frame that was not the port's");
    driver->owner[frame_id] = OWNER_DRIVER_AGAIN;
    if (driver->kind[frame_id] != FRAME_WITHOUT_SAMPLES)
        TEST_ASSERT_EQUAL_PTR(driver->buffers[driver->buffer[frame_id]], frame->samples);
    /* From here on the camera may write to it: whoever still reads finds something else. */
    memset(driver->buffers[driver->buffer[frame_id]], 0x15, sizeof driver->buffers[0]);
    driver->is_lent[driver->buffer[frame_id]] = false;
    driver_pass_point(driver);
}

static void cache_invalidate(roadpose_camera_context_t *driver, const void *address, size_t bytes) {
    driver_pass_point(driver);
    TEST_ASSERT_FALSE_MESSAGE(driver->is_in_interrupt, "cache maintenance in the interrupt");
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, driver->lock_depth, "cache maintenance with the lock held");
    driver->invalidated[driver->invalidations % 2] = address;
    driver->invalidated_bytes[driver->invalidations % 2] = bytes;
    driver->invalidations++;
    driver_pass_point(driver);
}

static void assert_same_pose(const roadpose_pose_t *expected, const roadpose_pose_t *pose) {
    TEST_ASSERT_EQUAL_UINT8(expected->status, pose->status);
    TEST_ASSERT_EQUAL_UINT8(expected->observed, pose->observed);
    TEST_ASSERT_EQUAL_INT32(expected->pitch_urad, pose->pitch_urad);
    TEST_ASSERT_EQUAL_INT32(expected->roll_urad, pose->roll_urad);
    TEST_ASSERT_EQUAL_INT32(expected->height_um, pose->height_um);
    TEST_ASSERT_EQUAL_UINT32(expected->valid_samples, pose->valid_samples);
    TEST_ASSERT_EQUAL_UINT32(expected->road_points, pose->road_points);
    TEST_ASSERT_EQUAL_UINT16(expected->residual_millipx, pose->residual_millipx);
}

static void pose_ready(roadpose_camera_context_t *driver, uint32_t frame_id, uint64_t time_us,
                       const roadpose_pose_t *pose) {
    const roadpose_pose_t expected = driver_expected_pose(frame_id);

    driver_pass_point(driver);
    TEST_ASSERT_FALSE_MESSAGE(driver->is_in_interrupt, "a pose in the interrupt");
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, driver->lock_depth, "a pose with the lock held");
    TEST_ASSERT_TRUE_MESSAGE(driver->poses == 0 || frame_id > driver->last_pose_frame, "an older frame after a newer");
    TEST_ASSERT_EQUAL_INT_MESSAGE(OWNER_PORT, driver->owner[frame_id], "a pose of a frame that was given back");
    TEST_ASSERT_EQUAL_UINT64(UINT64_C(5000000000) + frame_id, time_us);
    assert_same_pose(&expected, pose);
    driver->last_pose_frame = frame_id;
    driver->last_pose = *pose;
    driver->poses++;
    driver_pass_point(driver);
}

roadpose_camera_platform_t driver_platform(roadpose_camera_context_t *driver) {
    const roadpose_camera_platform_t platform = {driver, lock, unlock, frame_release, cache_invalidate, pose_ready};

    return platform;
}

void driver_start(roadpose_camera_context_t *driver) {
    const roadpose_camera_platform_t platform = driver_platform(driver);

    memset(driver, 0, sizeof *driver);
    driver->strike[0] = DRIVER_NEVER;
    driver->strike[1] = DRIVER_NEVER;
    start_estimator(&driver->estimator);
    TEST_ASSERT_EQUAL_INT(ROADPOSE_OK, roadpose_camera_init(&driver->port, &platform, &driver->estimator));
    turn_shared(&driver->port);
}

/* Three buffers are enough: one is always the driver's to fill. */
static unsigned next_to_fill(const roadpose_camera_context_t *driver) {
    unsigned buffer = 0;

    while (buffer < DRIVER_BUFFERS && driver->is_lent[buffer])
        buffer++;
    TEST_ASSERT_TRUE_MESSAGE(buffer < DRIVER_BUFFERS, "the port holds all three buffers");
    return buffer;
}

static roadpose_frame_t frame_of_kind(const uint16_t *samples, frame_kind_t kind) {
    roadpose_frame_t frame = {samples, 2 * DRIVER_WIDTH, DRIVER_WIDTH, DRIVER_HEIGHT, NULL, 0};

    if (kind == FRAME_WRONG_SIZE)
        frame.height_px--;
    if (kind == FRAME_SHORT_STRIDE)
        frame.stride_bytes--;
    if (kind == FRAME_WITHOUT_SAMPLES)
        frame.samples = NULL;
    return frame;
}

void driver_interrupt(roadpose_camera_context_t *driver, frame_kind_t kind) {
    const uint32_t id = driver->next_frame++;
    roadpose_frame_t frame = frame_of_kind(driver->buffers[driver->filling], kind);

    TEST_ASSERT_TRUE_MESSAGE(id < DRIVER_FRAMES, "the ledger is full");
    driver->is_in_interrupt = true;
    driver_draw(driver->buffers[driver->filling], id);
    driver->is_lent[driver->filling] = true;
    driver->owner[id] = OWNER_PORT;
    driver->buffer[id] = (uint8_t)driver->filling;
    driver->kind[id] = (uint8_t)kind;
    TEST_ASSERT_TRUE(roadpose_camera_frame_ready(&driver->port, &frame, id, UINT64_C(5000000000) + id));
    memset(&frame, 0x5A, sizeof frame); /* it was copied */
    driver->filling = next_to_fill(driver);
    driver->is_in_interrupt = false;
}

void driver_stop(roadpose_camera_context_t *driver) {
    roadpose_camera_counters_t counters;

    roadpose_camera_flush(&driver->port);
    driver->strike[0] = DRIVER_NEVER; /* what struck during the flush itself is waiting */
    driver->strike[1] = DRIVER_NEVER;
    roadpose_camera_flush(&driver->port);
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAMERA_IDLE, roadpose_camera_task(&driver->port, UINT32_MAX));
    for (uint32_t id = 0; id < driver->next_frame; id++)
        TEST_ASSERT_EQUAL_INT_MESSAGE(OWNER_DRIVER_AGAIN, driver->owner[id], "a frame was never given back");
    roadpose_camera_read_counters(&driver->port, &counters);
    TEST_ASSERT_EQUAL_UINT32(driver->next_frame, counters.frames_ready);
    TEST_ASSERT_EQUAL_UINT32(driver->poses, counters.frames_finished);
    TEST_ASSERT_EQUAL_UINT32(counters.frames_ready, counters.frames_displaced + counters.frames_finished +
                                                        counters.frames_refused + counters.frames_flushed);
}
