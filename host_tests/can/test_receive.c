/* The listener: what it believes, and when it stops believing. */
#include <string.h>

#include "fake_bus.h"
#include "unity.h"

static roadpose_can_context_t bus;
static roadpose_can_transmit_t transmit;
static roadpose_can_receive_t receive;
static unsigned cycles;

static void begin(roadpose_e2e_profile_t profile) {
    const roadpose_can_port_t port = fake_bus_port(&bus);
    roadpose_can_settings_t settings;
    TEST_ASSERT_TRUE(roadpose_can_settings_default(&settings, profile));
    settings.id[1] = ROADPOSE_CAN_EXTENDED | 0x1ABCDEF0u;
    fake_bus_init(&bus);
    cycles = 0;
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_DONE, roadpose_can_transmit_init(&transmit, &settings, &port));
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_DONE, roadpose_can_receive_init(&receive, &settings));
}

void setUp(void) {
    begin(ROADPOSE_E2E_PROFILE_1);
}

void tearDown(void) {
}

/* Sends one cycle; the frames lie in bus.frame[bus.frames - 3...]. */
static void send_cycle(int32_t height_um) {
    roadpose_can_estimate_t estimate;
    memset(&estimate, 0, sizeof estimate);
    estimate.pose.valid = 7;
    estimate.pose.pitch_urad = 34907; /* 2 deg to the last micro-radian */
    estimate.pose.roll_urad = -34907;
    estimate.pose.height_um = height_um;
    estimate.quality.valid = 31;
    estimate.quality.yaw_urad = 34907;
    estimate.quality.support_permille = 870;
    estimate.quality.residual_millipx = 175;
    estimate.quality.range_near_mm = 3500;
    estimate.quality.range_far_mm = 24000;
    roadpose_can_transmit_publish(&transmit, &estimate, 0, cycles * 100000u);
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_DONE, roadpose_can_transmit_cycle(&transmit, cycles * 100000u));
    cycles++;
}

static roadpose_can_message_t hear(unsigned frame) {
    return roadpose_can_receive_frame(&receive, bus.frame[frame].id, bus.frame[frame].data, 8);
}

static void hear_cycle(void) {
    for (unsigned i = 3; i > 0; i--)
        (void)hear(bus.frames - i);
    roadpose_can_receive_cycle(&receive);
}

static void everything_arrives(roadpose_e2e_profile_t profile) {
    begin(profile);
    for (int i = 0; i < 300; i++) {
        send_cycle(1500000 + 1250 * i);
        hear_cycle();
        TEST_ASSERT_EQUAL_INT32(1500000 + 1250 * i, receive.view.pose.height_um);
        for (unsigned message = 0; message < ROADPOSE_CAN_MESSAGES; message++)
            TEST_ASSERT_EQUAL_UINT8((i == 0) ? ROADPOSE_E2E_INITIAL : ROADPOSE_E2E_OK, receive.view.e2e[message]);
    }
    TEST_ASSERT_EQUAL_INT32(34907, receive.view.pose.pitch_urad);
    TEST_ASSERT_EQUAL_INT32(-34907, receive.view.pose.roll_urad);
    TEST_ASSERT_EQUAL_INT32(34907, receive.view.quality.yaw_urad);
    TEST_ASSERT_EQUAL_UINT16(870, receive.view.quality.support_permille);
    TEST_ASSERT_EQUAL_UINT16(175, receive.view.quality.residual_millipx);
    TEST_ASSERT_EQUAL_UINT32(3500, receive.view.quality.range_near_mm);
    TEST_ASSERT_EQUAL_UINT32(24000, receive.view.quality.range_far_mm);
    TEST_ASSERT_EQUAL_UINT32(300 % 255, receive.view.status.frame_count);
}

static void everything_arrives_in_every_profile(void) {
    everything_arrives(ROADPOSE_E2E_PROFILE_1);
    everything_arrives(ROADPOSE_E2E_PROFILE_2);
    everything_arrives(ROADPOSE_E2E_PROFILE_5);
}

static void nothing_is_known_at_the_start(void) {
    TEST_ASSERT_EQUAL_HEX8(0, receive.view.pose.valid | receive.view.quality.valid | receive.view.status.valid);
    TEST_ASSERT_EQUAL_UINT8(15, receive.view.status.pose_status);
    TEST_ASSERT_EQUAL_UINT8(ROADPOSE_E2E_NO_NEW_DATA, receive.view.e2e[0]);
}

static void silence_makes_everything_invalid(void) {
    send_cycle(1500000);
    hear_cycle();
    for (int i = 0; i < 2; i++)
        roadpose_can_receive_cycle(&receive);
    TEST_ASSERT_EQUAL_HEX8(7, receive.view.pose.valid); /* two cycles are forgiven, three are the timeout */
    TEST_ASSERT_EQUAL_UINT8(ROADPOSE_E2E_NO_NEW_DATA, receive.view.e2e[0]);
    roadpose_can_receive_cycle(&receive);
    nothing_is_known_at_the_start();
    for (int i = 0; i < 600; i++)
        roadpose_can_receive_cycle(&receive);
    nothing_is_known_at_the_start();
    send_cycle(1500000);
    hear_cycle();
    TEST_ASSERT_EQUAL_HEX8(7, receive.view.pose.valid);
}

/* From the cycle after the last usable frame on: forgotten in the cycle that the setting says, and not before. */
static void every_timeout_is_kept(void) {
    roadpose_can_settings_t settings = receive.settings;
    for (unsigned timeout = 1; timeout <= 255; timeout++) {
        begin(ROADPOSE_E2E_PROFILE_1);
        settings.timeout_cycles = (uint8_t)timeout;
        TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_DONE, roadpose_can_receive_init(&receive, &settings));
        send_cycle(1500000);
        hear_cycle();
        for (unsigned cycle = 1; cycle < timeout; cycle++)
            roadpose_can_receive_cycle(&receive);
        TEST_ASSERT_EQUAL_HEX8(7, receive.view.pose.valid);
        roadpose_can_receive_cycle(&receive);
        nothing_is_known_at_the_start();
    }
}

static void damaged_frames_change_nothing_and_count(void) {
    send_cycle(1500000);
    hear_cycle();
    send_cycle(1000000);
    bus.frame[3].data[6] ^= 0x10u;
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_MESSAGE_POSE, hear(3));
    TEST_ASSERT_EQUAL_INT32(1500000, receive.view.pose.height_um);
    TEST_ASSERT_EQUAL_UINT8(ROADPOSE_E2E_CRC_ERROR, receive.view.e2e[0]);
    TEST_ASSERT_EQUAL_UINT32(1, receive.view.not_usable[0]);
}

static void a_stuck_sender_is_not_believed_for_ever(void) {
    send_cycle(1500000);
    hear_cycle();
    for (int i = 0; i < 3; i++)
        hear_cycle(); /* the same frames again */
    TEST_ASSERT_EQUAL_UINT8(ROADPOSE_E2E_REPEATED, receive.view.e2e[0]);
    TEST_ASSERT_EQUAL_HEX8(0, receive.view.pose.valid);
    TEST_ASSERT_EQUAL_UINT32(3, receive.view.not_usable[0]);
}

static void lost_frames_are_forgiven_up_to_the_allowance(void) {
    send_cycle(1500000);
    hear_cycle();
    for (int i = 0; i < 3; i++)
        send_cycle(1500000 + 1250 * i);
    (void)hear(bus.frames - 3);
    TEST_ASSERT_EQUAL_UINT8(ROADPOSE_E2E_SOME_LOST, receive.view.e2e[0]);
    for (int i = 0; i < 4; i++)
        send_cycle(2000000);
    (void)hear(bus.frames - 3);
    TEST_ASSERT_EQUAL_UINT8(ROADPOSE_E2E_WRONG_SEQUENCE, receive.view.e2e[0]);
    TEST_ASSERT_EQUAL_INT32(1502500, receive.view.pose.height_um);
}

static void frames_of_others_and_of_wrong_length_are_refused(void) {
    const uint8_t data[8] = {0};
    send_cycle(1500000);
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_MESSAGE_NONE, roadpose_can_receive_frame(&receive, 0x100, data, 8));
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_MESSAGE_NONE, roadpose_can_receive_frame(&receive, 0x1ABCDEF0u, data, 8));
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_MESSAGE_NONE, roadpose_can_receive_frame(&receive, 0x3D0, NULL, 8));
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_MESSAGE_NONE, roadpose_can_receive_frame(NULL, 0x3D0, data, 8));
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_MESSAGE_POSE, roadpose_can_receive_frame(&receive, 0x3D0, bus.frame[0].data, 7));
    TEST_ASSERT_EQUAL_UINT8(ROADPOSE_E2E_CRC_ERROR, receive.view.e2e[0]);
    TEST_ASSERT_EQUAL_HEX8(0, receive.view.pose.valid);
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_MESSAGE_QUALITY, hear(1)); /* the 29-bit one */
    roadpose_can_receive_cycle(NULL);
}

static void init_checks_its_arguments(void) {
    roadpose_can_settings_t settings;
    TEST_ASSERT_TRUE(roadpose_can_settings_default(&settings, ROADPOSE_E2E_PROFILE_5));
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_ERROR_NULL, roadpose_can_receive_init(NULL, &settings));
    settings.id[2] = settings.id[1];
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_ERROR_SETTINGS, roadpose_can_receive_init(&receive, &settings));
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_DONE, roadpose_can_receive_init(&receive, NULL));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(everything_arrives_in_every_profile);
    RUN_TEST(nothing_is_known_at_the_start);
    RUN_TEST(silence_makes_everything_invalid);
    RUN_TEST(every_timeout_is_kept);
    RUN_TEST(damaged_frames_change_nothing_and_count);
    RUN_TEST(a_stuck_sender_is_not_believed_for_ever);
    RUN_TEST(lost_frames_are_forgiven_up_to_the_allowance);
    RUN_TEST(frames_of_others_and_of_wrong_length_are_refused);
    RUN_TEST(init_checks_its_arguments);
    return UNITY_END();
}
