/* The template port runs as it stands: frames come back as estimates, and the bus that it does not have is counted. */
#include <string.h>

#include "template_port.h"
#include "unity.h"

static roadpose_template_t port;
static uint16_t samples[480][640];
static const roadpose_rig_t rig = {640, 480, 500000, 319500, 239500, 300000};

void setUp(void) {
}

void tearDown(void) {
}

static void begin(void) {
    roadpose_disparity_format_t format;
    TEST_ASSERT_TRUE(roadpose_format_preset(&format, ROADPOSE_FORMAT_U16_Q8));
    TEST_ASSERT_TRUE(roadpose_template_init(&port, &rig, &format));
}

static void drive(unsigned milliseconds, uint64_t from_us) {
    for (unsigned i = 0; i < milliseconds; i++)
        roadpose_template_task(&port, from_us + 1000u * i);
}

static void a_frame_becomes_an_estimate(void) {
    const roadpose_frame_t frame = {samples, sizeof samples[0], 640, 480, NULL, 0};
    begin();
    roadpose_template_camera_interrupt(&port, &frame, 1, 0);
    drive(1000, 500);
    TEST_ASSERT_EQUAL_UINT32(1, roadpose_can_transmit_counts(&port.transmit)->estimates);
    TEST_ASSERT_EQUAL_UINT32(1, roadpose_can_transmit_counts(&port.transmit)->refused); /* it is empty */
    TEST_ASSERT_EQUAL_UINT32(10, roadpose_can_transmit_counts(&port.transmit)->cycles);
    TEST_ASSERT_EQUAL_UINT32(1, roadpose_can_transmit_counts(&port.transmit)->down);
}

static void a_frame_of_another_size_is_reported(void) {
    const roadpose_frame_t frame = {samples, sizeof samples[0], 320, 240, NULL, 0};
    begin();
    roadpose_template_camera_interrupt(&port, &frame, 1, 0);
    drive(5, 0);
    TEST_ASSERT_EQUAL_UINT32(1, roadpose_can_transmit_counts(&port.transmit)->estimates);
    TEST_ASSERT_EQUAL_UINT8(ROADPOSE_CAN_STATUS_BAD_FRAME, port.transmit.newest.pose_status);
}

static void overwritten_frames_are_reported(void) {
    const roadpose_frame_t frame = {samples, sizeof samples[0], 640, 480, NULL, 0};
    begin();
    for (uint32_t i = 0; i < 4; i++)
        roadpose_template_camera_interrupt(&port, &frame, i, 0);
    drive(1000, 0);
    TEST_ASSERT_EQUAL_UINT32(3, roadpose_can_transmit_counts(&port.transmit)->overwritten);
    TEST_ASSERT_EQUAL_UINT32(1, roadpose_can_transmit_counts(&port.transmit)->estimates);
}

static uint32_t cycles_in(uint64_t period_us, unsigned tasks) {
    begin();
    for (unsigned i = 0; i < tasks; i++)
        roadpose_template_task(&port, i * period_us);
    return roadpose_can_transmit_counts(&port.transmit)->cycles;
}

/* Just under ten seconds each. */
static void the_cycle_does_not_depend_on_the_period_of_the_task(void) {
    TEST_ASSERT_EQUAL_UINT32(100, cycles_in(1000, 10000));
    TEST_ASSERT_EQUAL_UINT32(100, cycles_in(30000, 333));
    TEST_ASSERT_EQUAL_UINT32(100, cycles_in(99999, 101));
    TEST_ASSERT_EQUAL_UINT32(20, cycles_in(500000, 20)); /* too rare: one each, and none made up for */
}

static void a_clock_that_is_set_back_does_not_stop_the_cycle(void) {
    begin();
    drive(1000, UINT64_C(3600000000));
    drive(1000, 0);
    TEST_ASSERT_EQUAL_UINT32(20, roadpose_can_transmit_counts(&port.transmit)->cycles);
}

static void its_memory_over_power_off_is_empty(void) {
    const roadpose_store_port_t memory = roadpose_template_store_port();
    uint8_t byte = 7;
    TEST_ASSERT_FALSE(memory.store(memory.context, &byte, 1));
    TEST_ASSERT_FALSE(memory.recall(memory.context, &byte, 1));
    TEST_ASSERT_EQUAL_UINT8(7, byte);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(a_frame_becomes_an_estimate);
    RUN_TEST(a_frame_of_another_size_is_reported);
    RUN_TEST(overwritten_frames_are_reported);
    RUN_TEST(the_cycle_does_not_depend_on_the_period_of_the_task);
    RUN_TEST(a_clock_that_is_set_back_does_not_stop_the_cycle);
    RUN_TEST(its_memory_over_power_off_is_empty);
    return UNITY_END();
}
