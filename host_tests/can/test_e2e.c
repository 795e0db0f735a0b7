/* E2E protection: published vectors, counters, and the receiver's state machine. */
#include <string.h>

#include "roadpose/e2e.h"
#include "unity.h"

static roadpose_e2e_config_t config;

void setUp(void) {
    memset(&config, 0, sizeof config);
    config.profile = ROADPOSE_E2E_PROFILE_1;
    config.max_delta = 3;
    config.data_id = 0x123;
    for (uint8_t i = 0; i < ROADPOSE_E2E_LIST_ENTRIES; i++)
        config.data_id_list[i] = i;
}

void tearDown(void) {
}

static void expect_protected(uint8_t counter, const uint8_t in[8], const uint8_t out[8]) {
    uint8_t data[8];
    memcpy(data, in, 8);
    TEST_ASSERT_TRUE(roadpose_e2e_protect(&config, counter, data));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(out, data, 8);
}

static void profile_1_gives_the_published_bytes(void) {
    const uint8_t zeros[8] = {0};
    const uint8_t first[8] = {0xCC, 0x00};
    const uint8_t second[8] = {0x91, 0x01};
    expect_protected(0, zeros, first);
    expect_protected(1, zeros, second);
}

static void profile_2_gives_the_published_bytes(void) {
    const uint8_t in[8] = {0, 1, 2, 3, 4, 5, 6, 7};
    const uint8_t out[8] = {0xBC, 2, 2, 3, 4, 5, 6, 7};
    config.profile = ROADPOSE_E2E_PROFILE_2;
    expect_protected(2, in, out);
}

static void profile_5_gives_the_published_bytes(void) {
    const uint8_t zeros[8] = {0};
    const uint8_t out[8] = {0x1C, 0xCA};
    config.profile = ROADPOSE_E2E_PROFILE_5;
    config.data_id = 0x1234;
    expect_protected(0, zeros, out);
}

static void counters_run_over_at_the_end_of_their_profile(void) {
    TEST_ASSERT_EQUAL_UINT8(1, roadpose_e2e_next_counter(ROADPOSE_E2E_PROFILE_1, 0));
    TEST_ASSERT_EQUAL_UINT8(0, roadpose_e2e_next_counter(ROADPOSE_E2E_PROFILE_1, 14));
    TEST_ASSERT_EQUAL_UINT8(0, roadpose_e2e_next_counter(ROADPOSE_E2E_PROFILE_1, 15));
    TEST_ASSERT_EQUAL_UINT8(15, roadpose_e2e_next_counter(ROADPOSE_E2E_PROFILE_2, 14));
    TEST_ASSERT_EQUAL_UINT8(0, roadpose_e2e_next_counter(ROADPOSE_E2E_PROFILE_2, 15));
    TEST_ASSERT_EQUAL_UINT8(16, roadpose_e2e_next_counter(ROADPOSE_E2E_PROFILE_5, 15));
    TEST_ASSERT_EQUAL_UINT8(0, roadpose_e2e_next_counter(ROADPOSE_E2E_PROFILE_5, 255));
    TEST_ASSERT_EQUAL_UINT8(0, roadpose_e2e_next_counter(3, 7));
}

static void protect_refuses_what_is_out_of_range_and_leaves_the_data(void) {
    uint8_t data[8] = {9, 9, 9, 9, 9, 9, 9, 9};
    const uint8_t before[8] = {9, 9, 9, 9, 9, 9, 9, 9};
    TEST_ASSERT_FALSE(roadpose_e2e_protect(NULL, 0, data));
    TEST_ASSERT_FALSE(roadpose_e2e_protect(&config, 0, NULL));
    TEST_ASSERT_FALSE(roadpose_e2e_protect(&config, 15, data));
    config.profile = ROADPOSE_E2E_PROFILE_2;
    TEST_ASSERT_FALSE(roadpose_e2e_protect(&config, 16, data));
    config.profile = 4;
    TEST_ASSERT_FALSE(roadpose_e2e_protect(&config, 0, data));
    config.profile = ROADPOSE_E2E_PROFILE_1;
    config.max_delta = 0;
    TEST_ASSERT_FALSE(roadpose_e2e_protect(&config, 0, data));
    config.max_delta = 15;
    TEST_ASSERT_FALSE(roadpose_e2e_protect(&config, 0, data));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(before, data, 8);
}

static roadpose_e2e_status_t receive(roadpose_e2e_receiver_t *receiver, uint8_t counter) {
    uint8_t data[8] = {0, 0, 0, 1, 2, 3, 4, 5};
    TEST_ASSERT_TRUE(roadpose_e2e_protect(&config, counter, data));
    return roadpose_e2e_check(&config, receiver, data);
}

static void one_profile_goes_through_all_states(uint8_t profile, uint8_t largest) {
    roadpose_e2e_receiver_t receiver = {0};
    config.profile = profile;
    TEST_ASSERT_EQUAL_INT(ROADPOSE_E2E_NO_NEW_DATA, roadpose_e2e_check(&config, &receiver, NULL));
    TEST_ASSERT_EQUAL_INT(ROADPOSE_E2E_INITIAL, receive(&receiver, (uint8_t)(largest - 1)));
    TEST_ASSERT_EQUAL_INT(ROADPOSE_E2E_OK, receive(&receiver, largest));
    TEST_ASSERT_EQUAL_INT(ROADPOSE_E2E_OK, receive(&receiver, 0));
    TEST_ASSERT_EQUAL_INT(ROADPOSE_E2E_REPEATED, receive(&receiver, 0));
    TEST_ASSERT_EQUAL_INT(ROADPOSE_E2E_OK, receive(&receiver, 1));
    TEST_ASSERT_EQUAL_INT(ROADPOSE_E2E_SOME_LOST, receive(&receiver, 4));
    TEST_ASSERT_EQUAL_INT(ROADPOSE_E2E_WRONG_SEQUENCE, receive(&receiver, 8));
    TEST_ASSERT_EQUAL_INT(ROADPOSE_E2E_OK, receive(&receiver, 9));
    TEST_ASSERT_EQUAL_INT(ROADPOSE_E2E_WRONG_SEQUENCE, receive(&receiver, 8));
}

static void the_receiver_goes_through_all_states(void) {
    one_profile_goes_through_all_states(ROADPOSE_E2E_PROFILE_1, 14);
    one_profile_goes_through_all_states(ROADPOSE_E2E_PROFILE_2, 15);
    one_profile_goes_through_all_states(ROADPOSE_E2E_PROFILE_5, 255);
}

static void cycles_without_a_frame_widen_the_allowance(void) {
    roadpose_e2e_receiver_t receiver = {0};
    TEST_ASSERT_EQUAL_INT(ROADPOSE_E2E_INITIAL, receive(&receiver, 0));
    for (int i = 0; i < 4; i++)
        TEST_ASSERT_EQUAL_INT(ROADPOSE_E2E_NO_NEW_DATA, roadpose_e2e_check(&config, &receiver, NULL));
    TEST_ASSERT_EQUAL_INT(ROADPOSE_E2E_SOME_LOST, receive(&receiver, 7));
    TEST_ASSERT_EQUAL_INT(ROADPOSE_E2E_WRONG_SEQUENCE, receive(&receiver, 11)); /* and narrow again */
}

static void the_allowance_widens_by_one_a_cycle_and_no_more(void) {
    roadpose_e2e_receiver_t receiver = {0};
    TEST_ASSERT_EQUAL_INT(ROADPOSE_E2E_INITIAL, receive(&receiver, 0));
    for (int i = 0; i < 4; i++)
        TEST_ASSERT_EQUAL_INT(ROADPOSE_E2E_NO_NEW_DATA, roadpose_e2e_check(&config, &receiver, NULL));
    TEST_ASSERT_EQUAL_INT(ROADPOSE_E2E_WRONG_SEQUENCE, receive(&receiver, 8));
}

/* As in AUTOSAR: whatever came instead, another cycle has passed. */
static void damaged_and_repeated_frames_widen_the_allowance(void) {
    const uint8_t damaged[8] = {0xFF, 0, 0, 1, 2, 3, 4, 5};
    for (uint8_t beyond = 0; beyond < 2; beyond++) {
        roadpose_e2e_receiver_t receiver = {0};
        TEST_ASSERT_EQUAL_INT(ROADPOSE_E2E_INITIAL, receive(&receiver, 0));
        TEST_ASSERT_EQUAL_INT(ROADPOSE_E2E_CRC_ERROR, roadpose_e2e_check(&config, &receiver, damaged));
        TEST_ASSERT_EQUAL_INT(ROADPOSE_E2E_REPEATED, receive(&receiver, 0));
        TEST_ASSERT_EQUAL_INT(beyond ? ROADPOSE_E2E_WRONG_SEQUENCE : ROADPOSE_E2E_SOME_LOST,
                              receive(&receiver, (uint8_t)(5 + beyond)));
    }
}

static void a_long_silence_neither_overflows_nor_hides_a_repetition(void) {
    roadpose_e2e_receiver_t receiver = {0};
    TEST_ASSERT_EQUAL_INT(ROADPOSE_E2E_INITIAL, receive(&receiver, 5));
    for (int i = 0; i < 1000; i++)
        TEST_ASSERT_EQUAL_INT(ROADPOSE_E2E_NO_NEW_DATA, roadpose_e2e_check(&config, &receiver, NULL));
    TEST_ASSERT_EQUAL_INT(ROADPOSE_E2E_REPEATED, receive(&receiver, 5));
    TEST_ASSERT_EQUAL_INT(ROADPOSE_E2E_SOME_LOST, receive(&receiver, 4));
}

static void every_flipped_bit_is_found(uint8_t profile) {
    config.profile = profile;
    for (unsigned bit = 0; bit < 64; bit++) {
        roadpose_e2e_receiver_t receiver = {0};
        uint8_t data[8] = {0, 0, 0, 0xA5, 0x5A, 0xFF, 0x00, 0x37};
        TEST_ASSERT_TRUE(roadpose_e2e_protect(&config, 6, data));
        data[bit / 8] = (uint8_t)(data[bit / 8] ^ (1u << (bit % 8)));
        TEST_ASSERT_EQUAL_INT(ROADPOSE_E2E_CRC_ERROR, roadpose_e2e_check(&config, &receiver, data));
        TEST_ASSERT_EQUAL_INT(ROADPOSE_E2E_INITIAL, receive(&receiver, 6)); /* nothing was learnt from it */
    }
}

static void damage_is_found_in_every_profile(void) {
    every_flipped_bit_is_found(ROADPOSE_E2E_PROFILE_1);
    every_flipped_bit_is_found(ROADPOSE_E2E_PROFILE_2);
    every_flipped_bit_is_found(ROADPOSE_E2E_PROFILE_5);
}

static void another_message_is_not_taken_for_ours(void) {
    roadpose_e2e_receiver_t receiver = {0};
    uint8_t data[8] = {0};
    TEST_ASSERT_TRUE(roadpose_e2e_protect(&config, 0, data));
    config.data_id = 0x124;
    TEST_ASSERT_EQUAL_INT(ROADPOSE_E2E_CRC_ERROR, roadpose_e2e_check(&config, &receiver, data));
}

/* The lines below are the CRC of profile 1 written again as plain long division, so that the frame is right but for
 * its counter. */
static uint8_t long_division(const uint8_t *bytes, unsigned count) {
    unsigned remainder = 0;
    for (unsigned bit = 0; bit < 8 * count; bit++) {
        unsigned top = ((remainder >> 7) ^ (unsigned)(bytes[bit / 8] >> (7 - bit % 8))) & 1u;
        remainder = ((remainder << 1) & 0xFFu) ^ (top ? 0x1Du : 0u);
    }
    return (uint8_t)remainder;
}

static void counter_15_is_an_error_in_profile_1(void) {
    roadpose_e2e_receiver_t receiver = {0};
    const uint8_t bytes[9] = {0x23, 0x01, 0x0F};
    uint8_t data[8] = {0, 0x0F};
    data[0] = long_division(bytes, 9);
    TEST_ASSERT_EQUAL_INT(ROADPOSE_E2E_CRC_ERROR, roadpose_e2e_check(&config, &receiver, data));
}

static void checks_survive_null_and_unknown_profiles(void) {
    roadpose_e2e_receiver_t receiver = {0};
    const uint8_t data[8] = {0xCC};
    TEST_ASSERT_EQUAL_INT(ROADPOSE_E2E_CRC_ERROR, roadpose_e2e_check(NULL, &receiver, data));
    TEST_ASSERT_EQUAL_INT(ROADPOSE_E2E_CRC_ERROR, roadpose_e2e_check(&config, NULL, data));
    config.profile = 9;
    TEST_ASSERT_EQUAL_INT(ROADPOSE_E2E_CRC_ERROR, roadpose_e2e_check(&config, &receiver, data));
    TEST_ASSERT_FALSE(roadpose_e2e_config_valid(NULL));
}

static void only_the_first_three_states_are_usable(void) {
    for (int status = 0; status <= ROADPOSE_E2E_NO_NEW_DATA; status++)
        TEST_ASSERT_EQUAL(status <= ROADPOSE_E2E_INITIAL, roadpose_e2e_usable((roadpose_e2e_status_t)status));
    TEST_ASSERT_EQUAL_STRING("ok", roadpose_e2e_status_word(ROADPOSE_E2E_OK));
    TEST_ASSERT_EQUAL_STRING("wrong_sequence", roadpose_e2e_status_word(ROADPOSE_E2E_WRONG_SEQUENCE));
    TEST_ASSERT_EQUAL_STRING("no_new_data", roadpose_e2e_status_word(ROADPOSE_E2E_NO_NEW_DATA));
    TEST_ASSERT_EQUAL_STRING("unknown", roadpose_e2e_status_word((roadpose_e2e_status_t)7));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(profile_1_gives_the_published_bytes);
    RUN_TEST(profile_2_gives_the_published_bytes);
    RUN_TEST(profile_5_gives_the_published_bytes);
    RUN_TEST(counters_run_over_at_the_end_of_their_profile);
    RUN_TEST(protect_refuses_what_is_out_of_range_and_leaves_the_data);
    RUN_TEST(the_receiver_goes_through_all_states);
    RUN_TEST(cycles_without_a_frame_widen_the_allowance);
    RUN_TEST(the_allowance_widens_by_one_a_cycle_and_no_more);
    RUN_TEST(damaged_and_repeated_frames_widen_the_allowance);
    RUN_TEST(a_long_silence_neither_overflows_nor_hides_a_repetition);
    RUN_TEST(damage_is_found_in_every_profile);
    RUN_TEST(another_message_is_not_taken_for_ours);
    RUN_TEST(counter_15_is_an_error_in_profile_1);
    RUN_TEST(checks_survive_null_and_unknown_profiles);
    RUN_TEST(only_the_first_three_states_are_usable);
    return UNITY_END();
}
