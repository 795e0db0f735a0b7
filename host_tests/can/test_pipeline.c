/* Camera to bus, with faults on both sides at once: frames that are late, early, doubled, torn or of another size, and
 * sending that fails at call N, for every N until a drive completes without meeting the fault. Whatever happens, every
 * buffer comes back once, every cycle of a bus that works has its three messages, and what they say is true. */
#include <math.h>
#include <string.h>

#include "fake_bus.h"
#include "roadpose/camera_port.h"
#include "synthetic.h"
#include "unity.h"

#define WIDTH 320
#define HEIGHT 240
#define TICK_US 10000u
#define TICKS_A_CYCLE 2u
#define SLICES_A_TICK 160u /* a frame of this size takes two ticks */
#define PI 3.14159265358979323846

typedef enum { NOTHING, GOOD, DOUBLED, TORN, OTHER_SIZE } event_t;

/* What the camera does at each tick: on time every fourth, then late, early, and all the rest. */
static const event_t script[] = {
    GOOD,       NOTHING, NOTHING, NOTHING, GOOD,    NOTHING, NOTHING, NOTHING, NOTHING, NOTHING, GOOD,    GOOD,
    GOOD,       NOTHING, NOTHING, DOUBLED, NOTHING, NOTHING, NOTHING, TORN,    NOTHING, NOTHING, NOTHING, NOTHING,
    OTHER_SIZE, NOTHING, NOTHING, NOTHING, GOOD,    NOTHING, NOTHING, NOTHING, NOTHING, NOTHING, NOTHING, NOTHING,
    NOTHING,    NOTHING, GOOD,    NOTHING, NOTHING, NOTHING, NOTHING, NOTHING, NOTHING, NOTHING};
#define TICKS (sizeof script / sizeof script[0])

struct roadpose_camera_context {
    roadpose_camera_port_t port;
    roadpose_t estimator;
    uint64_t now_us;
    unsigned lent;
    unsigned back;
    unsigned poses;
    bool is_torn; /* a torn frame has been handed over */
};

static struct roadpose_camera_context camera;
static roadpose_can_context_t bus;
static roadpose_can_transmit_t transmit;
static roadpose_rig_t rig;
static uint16_t road[HEIGHT * WIDTH], other_road[HEIGHT * WIDTH], torn[HEIGHT * WIDTH];
static const true_pose_t pose_of_road = {4.0, -3.0, 1.4};

void setUp(void) {
    const true_pose_t other = {4.0, 9.0, 1.4};
    rig = (roadpose_rig_t){WIDTH, HEIGHT, 250000, 159500, 119500, 300000};
    render_road(&rig, pose_of_road, ROADPOSE_MAX_DISPARITY, road);
    render_road(&rig, other, ROADPOSE_MAX_DISPARITY, other_road);
}

void tearDown(void) {
}

static void take_back(roadpose_camera_context_t *context, const roadpose_frame_t *frame, uint32_t frame_id) {
    (void)frame;
    (void)frame_id;
    context->back++;
}

static void publish(const roadpose_pose_t *pose) {
    roadpose_camera_counters_t counters;
    roadpose_can_estimate_t estimate;
    roadpose_camera_read_counters(&camera.port, &counters);
    roadpose_can_estimate(&estimate, pose);
    roadpose_can_transmit_publish(&transmit, &estimate, counters.frames_displaced, camera.now_us);
}

static void pose_ready(roadpose_camera_context_t *context, uint32_t frame_id, uint64_t time_us,
                       const roadpose_pose_t *pose) {
    (void)frame_id;
    (void)time_us;
    context->poses++;
    publish(pose);
}

static void hand_over(const uint16_t *samples, uint16_t width, uint16_t height) {
    const roadpose_frame_t frame = {samples, 2u * WIDTH, width, height, NULL, 0};
    TEST_ASSERT_TRUE(roadpose_camera_frame_ready(&camera.port, &frame, camera.lent, camera.now_us));
    camera.lent++;
}

/* A torn frame: while it is worked on, the camera already writes the next one over its upper half. */
static void tear(void) {
    memcpy(torn, other_road, sizeof torn / 2);
}

static void strike(event_t event) {
    if (event == GOOD || event == DOUBLED)
        hand_over(road, WIDTH, HEIGHT);
    if (event == DOUBLED)
        hand_over(road, WIDTH, HEIGHT);
    if (event == OTHER_SIZE)
        hand_over(road, WIDTH / 2, HEIGHT / 2);
    if (event == TORN) {
        memcpy(torn, road, sizeof torn);
        hand_over(torn, WIDTH, HEIGHT);
    }
}

static void work(event_t event) {
    roadpose_camera_progress_t progress = roadpose_camera_task(&camera.port, SLICES_A_TICK / 2);
    if (event == TORN)
        tear();
    if (progress == ROADPOSE_CAMERA_WORKING)
        progress = roadpose_camera_task(&camera.port, SLICES_A_TICK / 2);
    if (progress == ROADPOSE_CAMERA_REFUSED)
        publish(NULL);
}

static void start(void) {
    const roadpose_camera_platform_t platform = {&camera, NULL, NULL, take_back, NULL, pose_ready};
    const roadpose_can_port_t port = fake_bus_port(&bus);
    const roadpose_disparity_format_t format = format_u16_q8();
    roadpose_can_settings_t settings;
    TEST_ASSERT_TRUE(roadpose_can_settings_default(&settings, ROADPOSE_E2E_PROFILE_1));
    settings.cycle_us = TICKS_A_CYCLE * TICK_US;
    settings.max_age_us = 60000;
    camera.lent = camera.back = camera.poses = 0;
    camera.is_torn = false;
    TEST_ASSERT_EQUAL_INT(ROADPOSE_OK, roadpose_init(&camera.estimator, &rig, &format, NULL));
    TEST_ASSERT_EQUAL_INT(ROADPOSE_OK, roadpose_camera_init(&camera.port, &platform, &camera.estimator));
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_DONE, roadpose_can_transmit_init(&transmit, &settings, &port));
}

static void drive(roadpose_can_send_t fault, unsigned fail_at, unsigned calls) {
    fake_bus_init(&bus);
    bus.fail_from = fail_at;
    bus.fail_to = fail_at + calls - 1u;
    bus.fail_with = fault;
    start();
    for (unsigned tick = 0; tick < TICKS; tick++) {
        camera.now_us = (uint64_t)tick * TICK_US;
        strike(script[tick]);
        work(script[tick]);
        if (tick % TICKS_A_CYCLE == 0)
            (void)roadpose_can_transmit_cycle(&transmit, camera.now_us);
        else
            (void)roadpose_can_transmit_poll(&transmit, camera.now_us);
    }
    roadpose_camera_flush(&camera.port);
}

static void expect_buffers_back(void) {
    roadpose_camera_counters_t counters;
    roadpose_camera_read_counters(&camera.port, &counters);
    TEST_ASSERT_EQUAL_UINT(camera.lent, camera.back);
    TEST_ASSERT_EQUAL_UINT32(1, counters.frames_refused);
    TEST_ASSERT_TRUE(counters.frames_displaced >= 1);
    TEST_ASSERT_EQUAL_UINT32(roadpose_can_transmit_counts(&transmit)->estimates, camera.poses + 1u);
}

/* A pose on the bus is that of the road, but for the torn frame, whose number is given. */
static void expect_true(const roadpose_can_view_t *view, uint32_t torn_frame) {
    if (view->pose.valid != 7u || view->status.frame_count == torn_frame)
        return;
    TEST_ASSERT_DOUBLE_WITHIN(0.02, pose_of_road.pitch_deg, view->pose.pitch_urad * 180e-6 / PI);
    TEST_ASSERT_DOUBLE_WITHIN(0.02, pose_of_road.roll_deg, view->pose.roll_urad * 180e-6 / PI);
    TEST_ASSERT_DOUBLE_WITHIN(0.005, pose_of_road.height_m, view->pose.height_um * 1e-6);
}

/* What a listener makes of it. Returns which statuses it saw, a bit each. */
static unsigned listen_to_bus(uint32_t torn_frame) {
    roadpose_can_receive_t receive;
    unsigned seen = 0;
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_DONE, roadpose_can_receive_init(&receive, NULL));
    for (unsigned i = 0; i < bus.frames; i++) {
        const roadpose_can_message_t message =
            roadpose_can_receive_frame(&receive, bus.frame[i].id, bus.frame[i].data, 8);
        TEST_ASSERT_TRUE(roadpose_e2e_usable((roadpose_e2e_status_t)receive.view.e2e[message]));
        if (message == ROADPOSE_CAN_MESSAGE_STATUS) {
            seen |= 1u << receive.view.status.pose_status;
            expect_true(&receive.view, torn_frame);
        }
    }
    return seen;
}

/* Which estimate is that of the torn frame: the first after it was handed over, for the one before it is finished. */
static uint32_t number_of_torn_frame(void) {
    start();
    uint32_t number = 0;
    for (unsigned tick = 0; tick < TICKS && number == 0; tick++) {
        const uint32_t before = roadpose_can_transmit_counts(&transmit)->estimates;
        camera.now_us = (uint64_t)tick * TICK_US;
        strike(script[tick]);
        camera.is_torn = camera.is_torn || script[tick] == TORN;
        work(script[tick]);
        if (camera.is_torn && roadpose_can_transmit_counts(&transmit)->estimates > before)
            number = before + 1u;
    }
    return number;
}

static void a_drive_without_bus_faults(void) {
    const unsigned expected =
        1u << ROADPOSE_STATUS_OK | 1u << ROADPOSE_CAN_STATUS_BAD_FRAME | 1u << ROADPOSE_CAN_STATUS_NO_FRAME;
    const uint32_t torn_frame = number_of_torn_frame();
    drive(ROADPOSE_CAN_FULL, 100000, 1);
    expect_buffers_back();
    TEST_ASSERT_EQUAL_UINT(3u * TICKS / TICKS_A_CYCLE, bus.frames);
    TEST_ASSERT_EQUAL_HEX(expected, listen_to_bus(torn_frame) & expected);
}

static void fail_everywhere(roadpose_can_send_t fault, unsigned calls) {
    const uint32_t torn_frame = number_of_torn_frame();
    unsigned fail_at = 0;
    do {
        fail_at++;
        drive(fault, fail_at, calls);
        expect_buffers_back();
        (void)listen_to_bus(torn_frame);
        TEST_ASSERT_TRUE(bus.frames + 3u * calls >= 3u * TICKS / TICKS_A_CYCLE);
    } while (bus.sends >= fail_at);
}

static void sending_fails_at_every_call(void) {
    fail_everywhere(ROADPOSE_CAN_FULL, 1);
    fail_everywhere(ROADPOSE_CAN_DOWN, 1);
    fail_everywhere(ROADPOSE_CAN_BUS_OFF, 3);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(a_drive_without_bus_faults);
    RUN_TEST(sending_fails_at_every_call);
    return UNITY_END();
}
