/* Each gate of the yaw by itself: the frame it must refuse, and the same frame without the reason. */
#include <math.h>

#include "drive_simulation.h"
#include "roadpose/heading.h"
#include "unity.h"

static random_numbers_t numbers;
static roadpose_heading_t heading;
static roadpose_track_t tracks[SIMULATION_TRACKS_MAX];
static const simulated_mount_t mount = {0.02, 0.01, 0.03, 1.5};
static const roadpose_motion_t nothing_told = {.interval_us = 100000};
static const roadpose_motion_t straight_told = {.interval_us = 100000, .has_speed = true, .has_yaw_rate = true,
                                                .speed_mm_s = 12000};

void setUp(void) {}
void tearDown(void) {}

static void see(double rate_deg_s, double noise_px, double outliers, int count) {
    static simulated_tracks_t simulated;
    const simulated_step_t step = {1.2, radians_of(rate_deg_s / 10), noise_px, outliers, count};
    simulate_tracks(&simulated, &SIMULATED_RIG, &mount, &step, &numbers);
    library_tracks(&simulated, &SIMULATED_RIG, tracks);
}

static roadpose_yaw_t judge(const roadpose_heading_settings_t *settings, const roadpose_motion_t *motion, size_t count) {
    const roadpose_rig_t rig = library_rig(&SIMULATED_RIG);
    int32_t normal[3];
    roadpose_yaw_t yaw;
    mount_normal_q30(&mount, normal);
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_heading_init(&heading, &rig, settings));
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_heading_process(&heading, tracks, count, motion, normal, &yaw));
    return yaw;
}

static void test_settings_of_the_gates(void) {
    roadpose_heading_settings_t usual, s;
    roadpose_heading_settings_default(&usual);
    see(0, 0.3, 0, 200);
    TEST_ASSERT_EQUAL(ROADPOSE_YAW_OK, judge(&usual, &nothing_told, 200).status);
    TEST_ASSERT_EQUAL(ROADPOSE_YAW_OK, judge(&usual, &straight_told, 200).status);
    s = usual;
    s.noise_max_millipx = 100;
    TEST_ASSERT_EQUAL(ROADPOSE_YAW_NOISY, judge(&s, &straight_told, 200).status);
    s = usual;
    s.sigma_max_urad = 100;
    TEST_ASSERT_EQUAL(ROADPOSE_YAW_UNCERTAIN, judge(&s, &straight_told, 200).status);
    s = usual;
    s.rate_sigma_max_urad_s = 1000;
    TEST_ASSERT_EQUAL(ROADPOSE_YAW_AMBIGUOUS, judge(&s, &nothing_told, 200).status);
    TEST_ASSERT_EQUAL(ROADPOSE_YAW_OK, judge(&s, &straight_told, 200).status);
    s = usual;
    s.share_min_permille = 1000;
    see(0, 0.3, 0.3, 200);
    TEST_ASSERT_EQUAL(ROADPOSE_YAW_NO_FOCUS, judge(&s, &straight_told, 200).status);
}

/* What a free rotation leaves open counts only where no yaw rate is told. It is about twice the deviation, in half of the
 * frames more: with just that deviation allowed, those are refused. */
static void test_what_a_free_rotation_leaves_open(void) {
    roadpose_heading_settings_t s;
    int refused = 0;
    roadpose_heading_settings_default(&s);
    for (int i = 0; i < 60; i++) {
        see(0, 0.3, 0, 150);
        const roadpose_yaw_t usual = judge(NULL, &straight_told, 150);
        if (usual.status != ROADPOSE_YAW_OK) continue; /* a frame with much error */
        s.sigma_max_urad = usual.sigma_urad + 1;
        TEST_ASSERT_EQUAL(ROADPOSE_YAW_OK, judge(&s, &straight_told, 150).status);
        refused += judge(&s, &nothing_told, 150).status == ROADPOSE_YAW_UNCERTAIN;
    }
    TEST_ASSERT_GREATER_THAN(10, refused);
}

static void test_turns_to_both_sides(void) {
    static const double rates[] = {-14, -10, -6, 6, 10, 14};
    for (int i = 0; i < 6; i++) {
        see(rates[i], 0.2, 0.1, 200);
        const roadpose_yaw_t yaw = judge(NULL, &nothing_told, 200);
        TEST_ASSERT_EQUAL(ROADPOSE_YAW_TURNING, yaw.status);
        TEST_ASSERT_DOUBLE_WITHIN(1, rates[i], degrees_of(1e-6 * yaw.yaw_rate_urad_s));
    }
}

/* The rate follows the time between the frames. */
static void test_interval(void) {
    roadpose_motion_t slow = nothing_told;
    slow.interval_us = 400000;
    see(3, 0.1, 0, 200);
    const roadpose_yaw_t fast = judge(NULL, &nothing_told, 200);
    const roadpose_yaw_t same = judge(NULL, &slow, 200);
    TEST_ASSERT_DOUBLE_WITHIN(0.5, 3, degrees_of(1e-6 * fast.yaw_rate_urad_s));
    TEST_ASSERT_INT_WITHIN(2, fast.yaw_rate_urad_s / 4, same.yaw_rate_urad_s);
    TEST_ASSERT_INT_WITHIN(2, fast.yaw_rate_sigma_urad_s / 4, same.yaw_rate_sigma_urad_s);
}

/* Thirty tracks move, 170 stand still: a lorry that drives past. */
static void test_few_move(void) {
    see(0, 0.1, 0, 200);
    for (int i = 0; i < 170; i++) {
        tracks[i].u1_q8 = tracks[i].u0_q8;
        tracks[i].v1_q8 = tracks[i].v0_q8;
    }
    TEST_ASSERT_EQUAL(ROADPOSE_YAW_STANDING, judge(NULL, &straight_told, 200).status);
    for (int i = 0; i < 100; i++) tracks[i].u0_q8 = -1;
    TEST_ASSERT_EQUAL(ROADPOSE_YAW_OK, judge(NULL, &straight_told, 200).status);
}

/* 640 x 480, f = 500: one track for each reason to drop it, beside one that is used. */
static void test_dropped_tracks(void) {
    static const roadpose_track_t odd[] = {{100, 120000, 100, 479 * 256 + 1}, {160000, 100, 639 * 256 + 1, 100},
                                           {100, 479 * 256 + 1, 100, 100}, {-1, 100, 100, 100},
                                           {0, 100, 251 * 256, 100},       {100, 0, 100, 251 * 256},
                                           {251 * 256, 100, 0, 100},       {100, 251 * 256, 100, 0}};
    for (int i = 0; i < 8; i++) {
        tracks[0] = odd[i];
        tracks[1] = (roadpose_track_t){0, 0, 250 * 256, 0};
        tracks[2] = (roadpose_track_t){639 * 256, 479 * 256, 639 * 256, 230 * 256};
        const roadpose_yaw_t yaw = judge(NULL, &nothing_told, 3);
        TEST_ASSERT_EQUAL(1, yaw.dropped_outside);
        TEST_ASSERT_EQUAL(2, yaw.tracks_used);
    }
}

int main(void) {
    numbers = random_numbers("heading, gates");
    UNITY_BEGIN();
    RUN_TEST(test_settings_of_the_gates);
    RUN_TEST(test_what_a_free_rotation_leaves_open);
    RUN_TEST(test_turns_to_both_sides);
    RUN_TEST(test_interval);
    RUN_TEST(test_few_move);
    RUN_TEST(test_dropped_tracks);
    return UNITY_END();
}
