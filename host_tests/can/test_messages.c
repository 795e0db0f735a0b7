/* Packing and unpacking: every code, every micro-radian, the ends of the ranges and of the types. */
#include <math.h>
#include <string.h>

#include "roadpose/can.h"
#include "unity.h"

#define PI 3.14159265358979323846264338327950288L

void setUp(void) {
}

void tearDown(void) {
}

static uint32_t bits_of(const uint8_t data[8], unsigned start, unsigned bits) {
    uint32_t code = 0;
    for (unsigned i = 0; i < bits; i++)
        code |= (uint32_t)((data[(start + i) / 8] >> ((start + i) % 8)) & 1u) << i;
    return code;
}

static uint32_t nearest_code(int32_t urad, long double step_deg, int32_t zero, uint32_t invalid) {
    long double code = floorl((long double)urad * 180.0L / (PI * 1e6L) / step_deg + zero + 0.5L);
    return (code < 0 || code >= invalid) ? invalid : (uint32_t)code;
}

static void every_micro_radian_gets_the_nearest_code(void) {
    for (int32_t urad = -720000; urad <= 720000; urad++) {
        const roadpose_can_pose_t pose = {ROADPOSE_CAN_PITCH | ROADPOSE_CAN_ROLL, urad, -urad, 0};
        const roadpose_can_quality_t quality = {ROADPOSE_CAN_YAW, urad, 0, 0, 0, 0};
        uint8_t data[8];
        roadpose_can_pack_pose(&pose, data);
        if (bits_of(data, 24, 14) != nearest_code(urad, 0.005L, 8192, 16383) ||
            bits_of(data, 38, 14) != nearest_code(-urad, 0.005L, 8192, 16383))
            TEST_FAIL_MESSAGE("pitch or roll");
        roadpose_can_pack_quality(&quality, data);
        if (bits_of(data, 24, 12) != nearest_code(urad, 0.02L, 2048, 4095))
            TEST_FAIL_MESSAGE("yaw");
    }
}

static void every_micrometre_gets_the_nearest_code(void) {
    for (int32_t um = 150000; um <= 5400000; um += 7) {
        const roadpose_can_pose_t pose = {ROADPOSE_CAN_HEIGHT, 0, 0, um};
        const int32_t code = (um + 625 - 200000) < 0 ? 4095 : (um + 625 - 200000) / 1250;
        uint8_t data[8];
        roadpose_can_pack_pose(&pose, data);
        if (bits_of(data, 52, 12) != (uint32_t)(code > 4094 ? 4095 : code))
            TEST_FAIL_MESSAGE("height");
    }
}

static void put_bits(uint8_t data[8], unsigned start, unsigned bits, uint32_t code) {
    for (unsigned i = 0; i < bits; i++) {
        const unsigned mask = 1u << ((start + i) % 8);
        data[(start + i) / 8] = (uint8_t)((data[(start + i) / 8] & ~mask) | (((code >> i) & 1u) ? mask : 0u));
    }
}

/* A frame with one signal at each of its codes and all others invalid. pack(unpack(frame)) must be the frame again,
 * but for codes beyond the last valid one, which become the invalid code. */
static void expect_codes_return(unsigned message, unsigned start, unsigned bits, uint32_t last) {
    for (uint32_t code = 0; code < (UINT32_C(1) << bits); code++) {
        uint8_t data[8] = {0, 0, 0, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF}, again[8], expected[8];
        put_bits(data, start, bits, code);
        memcpy(expected, data, 8);
        if (code > last)
            put_bits(expected, start, bits, UINT32_MAX);
        if (message == ROADPOSE_CAN_MESSAGE_POSE) {
            roadpose_can_pose_t pose;
            roadpose_can_unpack_pose(data, &pose);
            roadpose_can_pack_pose(&pose, again);
        } else if (message == ROADPOSE_CAN_MESSAGE_QUALITY) {
            roadpose_can_quality_t quality;
            roadpose_can_unpack_quality(data, &quality);
            roadpose_can_pack_quality(&quality, again);
        } else {
            roadpose_can_status_t status;
            roadpose_can_unpack_status(data, &status);
            roadpose_can_pack_status(&status, again);
        }
        TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, again, 8);
    }
}

static void every_code_of_every_signal_returns(void) {
    expect_codes_return(ROADPOSE_CAN_MESSAGE_POSE, 24, 14, 16382);
    expect_codes_return(ROADPOSE_CAN_MESSAGE_POSE, 38, 14, 16382);
    expect_codes_return(ROADPOSE_CAN_MESSAGE_POSE, 52, 12, 4094);
    expect_codes_return(ROADPOSE_CAN_MESSAGE_QUALITY, 24, 12, 4094);
    expect_codes_return(ROADPOSE_CAN_MESSAGE_QUALITY, 36, 7, 100);
    expect_codes_return(ROADPOSE_CAN_MESSAGE_QUALITY, 43, 7, 126);
    expect_codes_return(ROADPOSE_CAN_MESSAGE_QUALITY, 50, 6, 62);
    expect_codes_return(ROADPOSE_CAN_MESSAGE_QUALITY, 56, 8, 254);
    expect_codes_return(ROADPOSE_CAN_MESSAGE_STATUS, 24, 4, 15);
    expect_codes_return(ROADPOSE_CAN_MESSAGE_STATUS, 28, 4, 15);
    for (unsigned start = 32; start < 64; start += 8)
        expect_codes_return(ROADPOSE_CAN_MESSAGE_STATUS, start, 8, 254);
}

static void expect_payload(const uint8_t data[8], uint8_t byte) {
    const uint8_t expected[8] = {0, 0, 0, byte, byte, byte, byte, byte};
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, data, 8);
}

static void null_and_nothing_valid_are_all_ones(void) {
    const roadpose_can_pose_t pose = {0, 1, 2, 3000000};
    const roadpose_can_quality_t quality = {0, 1, 2, 3, 4, 5};
    const roadpose_can_status_t status = {0, 15, 15, 1, 2, 3, 4};
    uint8_t data[8] = {1, 2, 3, 4, 5, 6, 7, 8};
    roadpose_can_pack_pose(NULL, data);
    expect_payload(data, 0xFF);
    roadpose_can_pack_pose(&pose, data);
    expect_payload(data, 0xFF);
    roadpose_can_pack_quality(NULL, data);
    expect_payload(data, 0xFF);
    roadpose_can_pack_quality(&quality, data);
    expect_payload(data, 0xFF);
    roadpose_can_pack_status(NULL, data);
    expect_payload(data, 0xFF);
    roadpose_can_pack_status(&status, data);
    expect_payload(data, 0xFF);
}

static void values_at_the_ends_of_the_types_are_invalid_not_wrapped(void) {
    const int32_t ends[] = {INT32_MIN, INT32_MIN + 1, -16777217, -16777216, 16777216, 16777217, INT32_MAX};
    uint8_t data[8];
    for (unsigned i = 0; i < sizeof ends / sizeof ends[0]; i++) {
        const roadpose_can_pose_t pose = {7, ends[i], ends[i], ends[i]};
        const roadpose_can_quality_t quality = {31, ends[i], UINT16_MAX, UINT16_MAX, UINT32_MAX, UINT32_MAX};
        roadpose_can_pack_pose(&pose, data);
        expect_payload(data, 0xFF);
        roadpose_can_pack_quality(&quality, data);
        expect_payload(data, 0xFF);
    }
}

static void lowest_codes_are_all_zeros(void) {
    const roadpose_can_pose_t pose = {7, -714887, -714887, 200000}; /* -40.96 deg */
    const roadpose_can_quality_t quality = {31, -714887, 0, 0, 0, 0};
    const roadpose_can_status_t status = {15, 0, 0, 0, 255, 510, UINT32_MAX}; /* 2^32 - 1 = 255 * 16843009 */
    uint8_t data[8];
    roadpose_can_pack_pose(&pose, data);
    expect_payload(data, 0);
    roadpose_can_pack_quality(&quality, data);
    expect_payload(data, 0);
    roadpose_can_pack_status(&status, data);
    expect_payload(data, 0);
}

static void an_estimate_takes_over_what_was_observed_only(void) {
    roadpose_pose_t pose;
    roadpose_can_estimate_t estimate;
    memset(&pose, 0, sizeof pose);
    pose.observed = ROADPOSE_OBSERVED_PITCH | ROADPOSE_OBSERVED_HEIGHT;
    pose.pitch_urad = 1000;
    pose.height_um = 1500000;
    roadpose_can_estimate(&estimate, &pose);
    TEST_ASSERT_EQUAL_HEX8(ROADPOSE_CAN_PITCH | ROADPOSE_CAN_HEIGHT, estimate.pose.valid);
    TEST_ASSERT_EQUAL_HEX8(30, estimate.quality.valid); /* an accepted frame: all but the yaw */
    TEST_ASSERT_EQUAL_UINT8(0, estimate.pose_status);
    TEST_ASSERT_EQUAL_UINT8(15, estimate.yaw_status);
}

static void a_refused_frame_keeps_the_figures_it_came_to(void) {
    roadpose_pose_t pose;
    roadpose_can_estimate_t estimate;
    memset(&pose, 0, sizeof pose);
    pose.status = ROADPOSE_STATUS_LITTLE_SUPPORT;
    pose.support_permille = 312;
    roadpose_can_estimate(&estimate, &pose);
    TEST_ASSERT_EQUAL_HEX8(0, estimate.pose.valid);
    TEST_ASSERT_EQUAL_HEX8(ROADPOSE_CAN_SUPPORT, estimate.quality.valid);
    TEST_ASSERT_EQUAL_UINT8(ROADPOSE_STATUS_LITTLE_SUPPORT, estimate.pose_status);
    roadpose_can_estimate(&estimate, NULL);
    TEST_ASSERT_EQUAL_UINT8(ROADPOSE_CAN_STATUS_BAD_FRAME, estimate.pose_status);
    TEST_ASSERT_EQUAL_HEX8(0, estimate.pose.valid | estimate.quality.valid);
    roadpose_can_estimate(NULL, &pose);
}

/* The work may stop after any of them. */
static void each_figure_of_a_refused_frame_stands_for_itself(void) {
    for (unsigned bit = ROADPOSE_CAN_SUPPORT; bit <= ROADPOSE_CAN_RANGE_FAR; bit <<= 1) {
        roadpose_pose_t pose;
        roadpose_can_estimate_t estimate;
        memset(&pose, 0, sizeof pose);
        pose.status = ROADPOSE_STATUS_POOR_FIT;
        pose.support_permille = (bit == ROADPOSE_CAN_SUPPORT) ? 1 : 0;
        pose.residual_millipx = (bit == ROADPOSE_CAN_RESIDUAL) ? 2 : 0;
        pose.range_near_mm = (bit == ROADPOSE_CAN_RANGE_NEAR) ? 3 : 0;
        pose.range_far_mm = (bit == ROADPOSE_CAN_RANGE_FAR) ? 4 : 0;
        roadpose_can_estimate(&estimate, &pose);
        TEST_ASSERT_EQUAL_HEX8(bit, estimate.quality.valid);
        TEST_ASSERT_EQUAL_UINT16(pose.support_permille, estimate.quality.support_permille);
        TEST_ASSERT_EQUAL_UINT16(pose.residual_millipx, estimate.quality.residual_millipx);
        TEST_ASSERT_EQUAL_UINT32(pose.range_near_mm, estimate.quality.range_near_mm);
        TEST_ASSERT_EQUAL_UINT32(pose.range_far_mm, estimate.quality.range_far_mm);
    }
}

static void yaw_is_valid_only_with_status_0(void) {
    roadpose_can_estimate_t estimate;
    roadpose_can_estimate(&estimate, NULL);
    roadpose_can_estimate_yaw(&estimate, 5, 0);
    TEST_ASSERT_EQUAL_HEX8(ROADPOSE_CAN_YAW, estimate.quality.valid);
    roadpose_can_estimate_yaw(&estimate, 5, 3);
    TEST_ASSERT_EQUAL_HEX8(0, estimate.quality.valid);
    TEST_ASSERT_EQUAL_UINT8(3, estimate.yaw_status);
    roadpose_can_estimate_yaw(NULL, 5, 0);
}

static void a_yaw_leaves_the_pose_and_its_figures_alone(void) {
    roadpose_pose_t pose;
    roadpose_can_estimate_t estimate;
    memset(&pose, 0, sizeof pose);
    pose.observed = ROADPOSE_OBSERVED_PITCH;
    pose.support_permille = 900;
    roadpose_can_estimate(&estimate, &pose);
    roadpose_can_estimate_yaw(&estimate, -34907, 0);
    TEST_ASSERT_EQUAL_HEX8(31, estimate.quality.valid);
    TEST_ASSERT_EQUAL_INT32(-34907, estimate.quality.yaw_urad);
    roadpose_can_estimate_yaw(&estimate, -34907, 2);
    TEST_ASSERT_EQUAL_HEX8(30, estimate.quality.valid);
    TEST_ASSERT_EQUAL_HEX8(ROADPOSE_CAN_PITCH, estimate.pose.valid);
    TEST_ASSERT_EQUAL_UINT16(900, estimate.quality.support_permille);
}

static void statuses_have_words(void) {
    TEST_ASSERT_EQUAL_STRING("ok", roadpose_can_status_word(0));
    TEST_ASSERT_EQUAL_STRING("outside_limits", roadpose_can_status_word(6));
    TEST_ASSERT_EQUAL_STRING("reserved", roadpose_can_status_word(7));
    TEST_ASSERT_EQUAL_STRING("bad_frame", roadpose_can_status_word(13));
    TEST_ASSERT_EQUAL_STRING("no_frame", roadpose_can_status_word(14));
    TEST_ASSERT_EQUAL_STRING("invalid", roadpose_can_status_word(15));
    TEST_ASSERT_EQUAL_STRING("invalid", roadpose_can_status_word(255));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(every_micro_radian_gets_the_nearest_code);
    RUN_TEST(every_micrometre_gets_the_nearest_code);
    RUN_TEST(every_code_of_every_signal_returns);
    RUN_TEST(null_and_nothing_valid_are_all_ones);
    RUN_TEST(values_at_the_ends_of_the_types_are_invalid_not_wrapped);
    RUN_TEST(lowest_codes_are_all_zeros);
    RUN_TEST(an_estimate_takes_over_what_was_observed_only);
    RUN_TEST(a_refused_frame_keeps_the_figures_it_came_to);
    RUN_TEST(each_figure_of_a_refused_frame_stands_for_itself);
    RUN_TEST(yaw_is_valid_only_with_status_0);
    RUN_TEST(a_yaw_leaves_the_pose_and_its_figures_alone);
    RUN_TEST(statuses_have_words);
    return UNITY_END();
}
