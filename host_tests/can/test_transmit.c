/* The sender: what goes out in which cycle. */
#include <limits.h>
#include <string.h>

#include "fake_bus.h"
#include "unity.h"

#define CYCLE_US 100000u

static roadpose_can_context_t bus;
static roadpose_can_transmit_t transmit;
static uint64_t now_us;

void setUp(void) {
    const roadpose_can_port_t port = fake_bus_port(&bus);
    fake_bus_init(&bus);
    now_us = UINT64_C(0xFFFFFFFF) - 3u * CYCLE_US; /* runs over 32 bits on the way */
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_DONE, roadpose_can_transmit_init(&transmit, NULL, &port));
}

void tearDown(void) {
}

static roadpose_can_result_t cycle(void) {
    now_us += CYCLE_US;
    return roadpose_can_transmit_cycle(&transmit, now_us);
}

static void publish(int32_t height_um, uint8_t status) {
    roadpose_can_estimate_t estimate;
    memset(&estimate, 0, sizeof estimate);
    estimate.pose.valid = (status == 0) ? 7u : 0u;
    estimate.pose.height_um = height_um;
    estimate.pose_status = status;
    estimate.yaw_status = 15;
    roadpose_can_transmit_publish(&transmit, &estimate, 5, now_us);
}

static roadpose_can_pose_t sent_pose(unsigned group) {
    roadpose_can_pose_t pose;
    roadpose_can_unpack_pose(bus.frame[3 * group].data, &pose);
    return pose;
}

static roadpose_can_status_t sent_status(unsigned group) {
    roadpose_can_status_t status;
    roadpose_can_unpack_status(bus.frame[3 * group + 2].data, &status);
    return status;
}

static void without_an_estimate_the_frames_say_so(void) {
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_DONE, cycle());
    TEST_ASSERT_EQUAL_UINT(3, bus.frames);
    for (uint32_t i = 0; i < 3; i++)
        TEST_ASSERT_EQUAL_HEX32(0x3D0 + i, bus.frame[i].id);
    TEST_ASSERT_EQUAL_HEX8(0, sent_pose(0).valid);
    TEST_ASSERT_EQUAL_UINT8(ROADPOSE_CAN_STATUS_NO_FRAME, sent_status(0).pose_status);
    TEST_ASSERT_EQUAL_UINT32(0, sent_status(0).frame_count);
}

static void an_estimate_is_sent_with_its_counts(void) {
    publish(1500000, 0);
    publish(0, ROADPOSE_STATUS_NO_ROAD);
    publish(1250000, 0);
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_DONE, cycle());
    TEST_ASSERT_EQUAL_INT32(1250000, sent_pose(0).height_um);
    TEST_ASSERT_EQUAL_UINT8(0, sent_status(0).pose_status);
    TEST_ASSERT_EQUAL_UINT8(15, sent_status(0).yaw_status);
    TEST_ASSERT_EQUAL_UINT32(3, sent_status(0).frame_count);
    TEST_ASSERT_EQUAL_UINT32(1, sent_status(0).refused_count);
    TEST_ASSERT_EQUAL_UINT32(5, sent_status(0).overwritten_count);
    TEST_ASSERT_TRUE(bus.frame[0].deadline_us == now_us + CYCLE_US);
}

static void an_estimate_is_held_until_it_is_too_old(void) {
    publish(1500000, 0);
    for (int i = 0; i < 4; i++)
        TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_DONE, cycle());
    TEST_ASSERT_EQUAL_HEX8(7, sent_pose(1).valid); /* 200 ms old */
    TEST_ASSERT_EQUAL_UINT32(1, sent_status(1).frame_count);
    TEST_ASSERT_EQUAL_HEX8(0, sent_pose(2).valid); /* 300 ms: more than 250 */
    TEST_ASSERT_EQUAL_UINT8(ROADPOSE_CAN_STATUS_NO_FRAME, sent_status(2).pose_status);
    TEST_ASSERT_EQUAL_HEX8(0, sent_pose(3).valid);
}

static void an_estimate_of_exactly_the_largest_age_is_sent(void) {
    publish(1500000, 0);
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_DONE, roadpose_can_transmit_cycle(&transmit, now_us + 250000u));
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_DONE, roadpose_can_transmit_cycle(&transmit, now_us + 250001u));
    TEST_ASSERT_EQUAL_HEX8(7, sent_pose(0).valid);
    TEST_ASSERT_EQUAL_HEX8(0, sent_pose(1).valid);
    TEST_ASSERT_EQUAL_UINT32(2, roadpose_can_transmit_counts(&transmit)->cycles);
}

static void an_estimate_dated_after_its_cycle_is_not_old(void) {
    now_us += 150000u;
    publish(1500000, 0);
    now_us -= 150000u;
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_DONE, cycle());
    TEST_ASSERT_EQUAL_HEX8(7, sent_pose(0).valid);
}

/* A camera with a clock of its own, or a clock that was set back: nobody can tell how old the pose is. */
static void an_estimate_of_another_clock_is_not_new_for_ever(void) {
    publish(1500000, 0);
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_DONE, roadpose_can_transmit_cycle(&transmit, now_us - CYCLE_US));
    TEST_ASSERT_EQUAL_HEX8(7, sent_pose(0).valid);
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_DONE, roadpose_can_transmit_cycle(&transmit, now_us - CYCLE_US - 1u));
    TEST_ASSERT_EQUAL_HEX8(0, sent_pose(1).valid);
    TEST_ASSERT_EQUAL_UINT8(ROADPOSE_CAN_STATUS_NO_FRAME, sent_status(1).pose_status);
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_DONE, cycle()); /* nor does it come back */
    TEST_ASSERT_EQUAL_HEX8(0, sent_pose(2).valid);
}

static void counters_start_at_the_constant_and_run_over(void) {
    for (int i = 0; i < 40; i++)
        TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_DONE, cycle());
    for (unsigned i = 0; i < bus.frames; i++)
        TEST_ASSERT_EQUAL_UINT8((ROADPOSE_E2E_FIRST_COUNTER + i / 3) % 15, fake_frame_counter(&bus.frame[i]));
}

static void a_full_queue_is_tried_again_until_the_cycle_ends(void) {
    bus.fail_from = 2;
    bus.fail_to = 5;
    bus.fail_with = ROADPOSE_CAN_FULL;
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_WAITING, cycle());
    TEST_ASSERT_EQUAL_UINT(1, bus.frames);
    for (unsigned i = 1; i < 4; i++)
        TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_WAITING, roadpose_can_transmit_poll(&transmit, now_us + i));
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_DONE, roadpose_can_transmit_poll(&transmit, now_us + CYCLE_US - 1));
    TEST_ASSERT_EQUAL_UINT(3, bus.frames);
    TEST_ASSERT_EQUAL_UINT32(0, roadpose_can_transmit_counts(&transmit)->dropped);
    TEST_ASSERT_EQUAL_UINT32(4, roadpose_can_transmit_counts(&transmit)->full);
}

static void a_full_queue_after_an_outage_is_a_bus_again(void) {
    bus.fail_from = 1;
    bus.fail_to = 1;
    bus.fail_with = ROADPOSE_CAN_DOWN;
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_NO_BUS, cycle());
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_NO_BUS, roadpose_can_transmit_poll(&transmit, now_us + CYCLE_US));
    bus.fail_from = bus.fail_to = 2;
    bus.fail_with = ROADPOSE_CAN_FULL;
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_WAITING, cycle());
    TEST_ASSERT_EQUAL_UINT(1, bus.recovers);
    TEST_ASSERT_EQUAL_UINT32(1, roadpose_can_transmit_counts(&transmit)->recovered);
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_DONE, cycle());
    TEST_ASSERT_EQUAL_UINT(1, bus.recovers);
    /* One cycle was lost, one only waited. */
    TEST_ASSERT_EQUAL_UINT8(ROADPOSE_E2E_FIRST_COUNTER + 1, fake_frame_counter(&bus.frame[0]));
}

static void expect_down(roadpose_can_send_t answer, uint32_t down, uint32_t bus_off) {
    bus.fail_from = 1;
    bus.fail_to = UINT_MAX;
    bus.fail_with = answer;
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_NO_BUS, cycle());
    TEST_ASSERT_EQUAL_UINT32(down, roadpose_can_transmit_counts(&transmit)->down);
    TEST_ASSERT_EQUAL_UINT32(bus_off, roadpose_can_transmit_counts(&transmit)->bus_off);
}

static void bus_off_is_counted_whatever_was_before(void) {
    expect_down(ROADPOSE_CAN_DOWN, 1, 0);
    expect_down(ROADPOSE_CAN_BUS_OFF, 1, 1);
    expect_down(ROADPOSE_CAN_BUS_OFF, 1, 1);
    expect_down(ROADPOSE_CAN_DOWN, 1, 1);
    expect_down(ROADPOSE_CAN_BUS_OFF, 1, 2);
    bus.fail_to = 0;
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_DONE, cycle());
    TEST_ASSERT_EQUAL_UINT32(1, roadpose_can_transmit_counts(&transmit)->recovered);
    expect_down(ROADPOSE_CAN_BUS_OFF, 2, 3);
}

static void after_the_deadline_nothing_old_is_sent(void) {
    bus.fail_from = 1;
    bus.fail_to = 1;
    bus.fail_with = ROADPOSE_CAN_FULL;
    publish(1000000, 0);
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_WAITING, cycle());
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_DONE, roadpose_can_transmit_poll(&transmit, now_us + CYCLE_US));
    TEST_ASSERT_EQUAL_UINT(0, bus.frames);
    TEST_ASSERT_EQUAL_UINT32(3, roadpose_can_transmit_counts(&transmit)->dropped);
    publish(2000000, 0);
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_DONE, cycle());
    TEST_ASSERT_EQUAL_INT32(2000000, sent_pose(0).height_um);
    /* Never sent, so its counter was free. */
    TEST_ASSERT_EQUAL_UINT8(ROADPOSE_E2E_FIRST_COUNTER, fake_frame_counter(&bus.frame[0]));
    TEST_ASSERT_EQUAL_UINT32(3, sent_status(0).dropped_count);
}

static void settings_and_pointers_are_checked(void) {
    roadpose_can_settings_t settings;
    roadpose_can_port_t port = fake_bus_port(&bus);
    roadpose_can_transmit_t before = transmit;
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_ERROR_NULL, roadpose_can_transmit_init(NULL, NULL, &port));
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_ERROR_NULL, roadpose_can_transmit_init(&transmit, NULL, NULL));
    memset(&settings, 0, sizeof settings);
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_ERROR_SETTINGS, roadpose_can_transmit_init(&transmit, &settings, &port));
    port.can_send = NULL;
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_ERROR_NULL, roadpose_can_transmit_init(&transmit, NULL, &port));
    TEST_ASSERT_EQUAL_MEMORY(&before, &transmit, sizeof before);
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_ERROR_NULL, roadpose_can_transmit_cycle(NULL, 0));
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_ERROR_NULL, roadpose_can_transmit_poll(NULL, 0));
    TEST_ASSERT_NULL(roadpose_can_transmit_counts(NULL));
    roadpose_can_transmit_publish(NULL, NULL, 0, 0);
    roadpose_can_transmit_publish(&transmit, NULL, 0, 0);
    TEST_ASSERT_EQUAL_UINT32(0, roadpose_can_transmit_counts(&transmit)->estimates);
}

#define EXPECT_REFUSED(change)                                                                                         \
    do {                                                                                                               \
        roadpose_can_settings_t settings;                                                                              \
        TEST_ASSERT_TRUE(roadpose_can_settings_default(&settings, ROADPOSE_E2E_PROFILE_1));                            \
        TEST_ASSERT_TRUE(roadpose_can_settings_valid(&settings));                                                      \
        change;                                                                                                        \
        TEST_ASSERT_FALSE(roadpose_can_settings_valid(&settings));                                                     \
    } while (0)

static void every_setting_has_its_range(void) {
    EXPECT_REFUSED(settings.id[0] = 0x800);
    EXPECT_REFUSED(settings.id[1] = ROADPOSE_CAN_EXTENDED | 0x20000000u);
    EXPECT_REFUSED(settings.id[2] = settings.id[0]);
    EXPECT_REFUSED(settings.id[2] = settings.id[1]);
    EXPECT_REFUSED(settings.e2e[2].data_id = settings.e2e[0].data_id);
    EXPECT_REFUSED(settings.e2e[1].data_id = settings.e2e[0].data_id);
    EXPECT_REFUSED(settings.e2e[1].profile = 4);
    EXPECT_REFUSED(settings.e2e[2].max_delta = 0);
    EXPECT_REFUSED(settings.cycle_us = 999);
    EXPECT_REFUSED(settings.cycle_us = 10000001);
    EXPECT_REFUSED(settings.max_age_us = 600000001);
    EXPECT_REFUSED(settings.timeout_cycles = 0);
    TEST_ASSERT_FALSE(roadpose_can_settings_valid(NULL));
    TEST_ASSERT_FALSE(roadpose_can_settings_default(NULL, ROADPOSE_E2E_PROFILE_1));
}

static void the_ends_of_the_ranges_are_allowed(void) {
    roadpose_can_settings_t settings;
    TEST_ASSERT_TRUE(roadpose_can_settings_default(&settings, ROADPOSE_E2E_PROFILE_2));
    settings.cycle_us = 1000;
    settings.max_age_us = 0;
    settings.timeout_cycles = 1;
    settings.e2e[0].max_delta = 1;
    TEST_ASSERT_TRUE(roadpose_can_settings_valid(&settings));
    settings.cycle_us = 10000000;
    settings.max_age_us = 600000000;
    settings.timeout_cycles = 255;
    settings.e2e[0].max_delta = 14;
    settings.id[0] = ROADPOSE_CAN_STANDARD_MASK;
    settings.id[1] = ROADPOSE_CAN_EXTENDED | ROADPOSE_CAN_EXTENDED_MASK;
    TEST_ASSERT_TRUE(roadpose_can_settings_valid(&settings));
}

static void lists_of_profile_2_never_agree(void) {
    roadpose_can_settings_t settings;
    TEST_ASSERT_TRUE(roadpose_can_settings_default(&settings, ROADPOSE_E2E_PROFILE_2));
    for (unsigned i = 0; i < ROADPOSE_E2E_LIST_ENTRIES; i++) {
        TEST_ASSERT_TRUE(settings.e2e[0].data_id_list[i] != settings.e2e[1].data_id_list[i]);
        TEST_ASSERT_TRUE(settings.e2e[0].data_id_list[i] != settings.e2e[2].data_id_list[i]);
        TEST_ASSERT_TRUE(settings.e2e[1].data_id_list[i] != settings.e2e[2].data_id_list[i]);
    }
}

/* Only what the profile uses is compared. */
static void messages_must_not_be_taken_for_each_other(void) {
    roadpose_can_settings_t settings;
    TEST_ASSERT_TRUE(roadpose_can_settings_default(&settings, ROADPOSE_E2E_PROFILE_2));
    settings.e2e[1].data_id = settings.e2e[0].data_id;
    TEST_ASSERT_TRUE(roadpose_can_settings_valid(&settings));
    for (unsigned i = 0; i < ROADPOSE_E2E_LIST_ENTRIES; i++) {
        const uint8_t entry = settings.e2e[2].data_id_list[i];
        settings.e2e[2].data_id_list[i] = settings.e2e[1].data_id_list[i];
        TEST_ASSERT_FALSE(roadpose_can_settings_valid(&settings));
        settings.e2e[2].data_id_list[i] = entry;
    }
    settings.e2e[1].profile = ROADPOSE_E2E_PROFILE_5;
    TEST_ASSERT_TRUE(roadpose_can_settings_valid(&settings));
}

static void a_default_with_an_unknown_profile_changes_nothing(void) {
    roadpose_can_settings_t settings, before;
    memset(&settings, 0x5A, sizeof settings);
    before = settings;
    TEST_ASSERT_FALSE(roadpose_can_settings_default(&settings, (roadpose_e2e_profile_t)3));
    TEST_ASSERT_FALSE(roadpose_can_settings_default(&settings, (roadpose_e2e_profile_t)257)); /* 1 in eight bits */
    TEST_ASSERT_EQUAL_MEMORY(&before, &settings, sizeof settings);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(without_an_estimate_the_frames_say_so);
    RUN_TEST(an_estimate_is_sent_with_its_counts);
    RUN_TEST(an_estimate_is_held_until_it_is_too_old);
    RUN_TEST(an_estimate_of_exactly_the_largest_age_is_sent);
    RUN_TEST(an_estimate_dated_after_its_cycle_is_not_old);
    RUN_TEST(an_estimate_of_another_clock_is_not_new_for_ever);
    RUN_TEST(counters_start_at_the_constant_and_run_over);
    RUN_TEST(a_full_queue_is_tried_again_until_the_cycle_ends);
    RUN_TEST(a_full_queue_after_an_outage_is_a_bus_again);
    RUN_TEST(bus_off_is_counted_whatever_was_before);
    RUN_TEST(after_the_deadline_nothing_old_is_sent);
    RUN_TEST(settings_and_pointers_are_checked);
    RUN_TEST(every_setting_has_its_range);
    RUN_TEST(the_ends_of_the_ranges_are_allowed);
    RUN_TEST(lists_of_profile_2_never_agree);
    RUN_TEST(messages_must_not_be_taken_for_each_other);
    RUN_TEST(a_default_with_an_unknown_profile_changes_nothing);
    return UNITY_END();
}
