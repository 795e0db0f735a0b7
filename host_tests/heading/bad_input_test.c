/* Whatever comes in: a status or a result code, no undefined behaviour (this runs under sanitizers too), and the same
 * answer every time. */
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "drive_simulation.h"
#include "roadpose/heading.h"
#include "unity.h"

static random_numbers_t numbers;
static roadpose_heading_t heading;
static const int32_t down[3] = {0, 1 << 30, 0};
static roadpose_track_t tracks[5000];

static roadpose_rig_t usual_rig(void) { return library_rig(&SIMULATED_RIG); }

void setUp(void) {
    const roadpose_rig_t rig = usual_rig();
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_heading_init(&heading, &rig, NULL));
}

void tearDown(void) {}

static roadpose_yaw_t process(size_t count) {
    roadpose_yaw_t yaw;
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_heading_process(&heading, tracks, count, NULL, down, &yaw));
    TEST_ASSERT_LESS_THAN(ROADPOSE_YAW_STATUS_COUNT, yaw.status);
    TEST_ASSERT_TRUE(yaw.status == ROADPOSE_YAW_OK || (yaw.yaw_urad == 0 && yaw.sigma_urad == 0 &&
                                                       yaw.pitch_motion_urad == 0 && yaw.pitch_difference_urad == 0));
    return yaw;
}

static void good_tracks(int count) {
    static simulated_tracks_t simulated;
    const simulated_mount_t mount = {0.02, 0.01, 0.03, 1.5};
    const simulated_step_t step = {1.2, 0, 0.2, 0, count};
    simulate_tracks(&simulated, &SIMULATED_RIG, &mount, &step, &numbers);
    library_tracks(&simulated, &SIMULATED_RIG, tracks);
}

static void test_null_and_order(void) {
    static roadpose_heading_t raw;
    const roadpose_rig_t rig = usual_rig();
    roadpose_running_yaw_t running;
    roadpose_yaw_t yaw;
    roadpose_heading_settings_default(NULL);
    TEST_ASSERT_EQUAL(ROADPOSE_ERROR_NULL, roadpose_heading_init(NULL, &rig, NULL));
    TEST_ASSERT_EQUAL(ROADPOSE_ERROR_NULL, roadpose_heading_init(&raw, NULL, NULL));
    TEST_ASSERT_EQUAL(ROADPOSE_ERROR_NULL, roadpose_heading_process(NULL, tracks, 1, NULL, down, &yaw));
    TEST_ASSERT_EQUAL(ROADPOSE_ERROR_NULL, roadpose_heading_process(&heading, NULL, 1, NULL, down, &yaw));
    TEST_ASSERT_EQUAL(ROADPOSE_ERROR_NULL, roadpose_heading_process(&heading, tracks, 1, NULL, down, NULL));
    TEST_ASSERT_EQUAL(ROADPOSE_ERROR_ORDER, roadpose_heading_process(&raw, tracks, 1, NULL, down, &yaw));
    TEST_ASSERT_EQUAL(ROADPOSE_ERROR_ORDER, roadpose_heading_running(&raw, &running));
    TEST_ASSERT_EQUAL(ROADPOSE_ERROR_ORDER, roadpose_heading_restart(&raw));
    TEST_ASSERT_EQUAL(ROADPOSE_ERROR_NULL, roadpose_heading_running(&heading, NULL));
    TEST_ASSERT_EQUAL(ROADPOSE_ERROR_NULL, roadpose_heading_running(NULL, &running));
    TEST_ASSERT_EQUAL(ROADPOSE_ERROR_NULL, roadpose_heading_restart(NULL));
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_heading_process(&heading, NULL, 0, NULL, down, &yaw));
    TEST_ASSERT_EQUAL(ROADPOSE_YAW_FEW_TRACKS, yaw.status);
    TEST_ASSERT_EQUAL(sizeof(roadpose_heading_t), roadpose_heading_state_bytes());
}

static void test_rigs(void) {
    const roadpose_rig_t good = usual_rig();
    roadpose_rig_t rig = good;
    rig.width_px = ROADPOSE_MAX_WIDTH + 1;
    TEST_ASSERT_EQUAL(ROADPOSE_ERROR_SIZE, roadpose_heading_init(&heading, &rig, NULL));
    rig = good;
    rig.focal_millipx = 49999;
    TEST_ASSERT_EQUAL(ROADPOSE_ERROR_RIG, roadpose_heading_init(&heading, &rig, NULL));
    rig = good;
    rig.cu_millipx = -1;
    TEST_ASSERT_EQUAL(ROADPOSE_ERROR_RIG, roadpose_heading_init(&heading, &rig, NULL));
    rig = good;
    rig.height_px = 63;
    TEST_ASSERT_EQUAL(ROADPOSE_ERROR_RIG, roadpose_heading_init(&heading, &rig, NULL));
}

static void refuse(const roadpose_heading_settings_t *settings) {
    const roadpose_rig_t rig = usual_rig();
    TEST_ASSERT_EQUAL(ROADPOSE_ERROR_SETTINGS, roadpose_heading_init(&heading, &rig, settings));
}

#define REFUSE(field, value)                                                                                             \
    do {                                                                                                                 \
        roadpose_heading_settings_t s;                                                                                   \
        roadpose_heading_settings_default(&s);                                                                           \
        s.field = value;                                                                                                 \
        refuse(&s);                                                                                                      \
    } while (0)

static void test_settings(void) {
    const roadpose_heading_settings_t zero = {0};
    refuse(&zero);
    REFUSE(tracks_min, 7);
    REFUSE(tracks_min, ROADPOSE_MAX_TRACKS + 1);
    REFUSE(share_min_permille, 99);
    REFUSE(share_min_permille, 1001);
    REFUSE(moving_min_millipx, 499);
    REFUSE(noise_max_millipx, 5001);
    REFUSE(speed_min_mm_s, -1);
    REFUSE(yaw_rate_max_urad_s, 999);
    REFUSE(rate_sigma_max_urad_s, 1000001);
    REFUSE(sigma_max_urad, 99);
    REFUSE(yaw_max_urad, 400001);
}

static void test_motion_and_normal(void) {
    const int32_t no_unit[3] = {0, 1 << 29, 0};
    roadpose_motion_t motion = {.interval_us = 999};
    roadpose_yaw_t yaw = {.status = 77};
    good_tracks(100);
    TEST_ASSERT_EQUAL(ROADPOSE_ERROR_SETTINGS, roadpose_heading_process(&heading, tracks, 100, &motion, down, &yaw));
    motion.interval_us = 10000001;
    TEST_ASSERT_EQUAL(ROADPOSE_ERROR_SETTINGS, roadpose_heading_process(&heading, tracks, 100, &motion, down, &yaw));
    TEST_ASSERT_EQUAL(ROADPOSE_ERROR_SETTINGS, roadpose_heading_process(&heading, tracks, 100, NULL, no_unit, &yaw));
    TEST_ASSERT_EQUAL(77, yaw.status);
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_heading_process(&heading, tracks, 100, NULL, NULL, &yaw));
    TEST_ASSERT_EQUAL(ROADPOSE_YAW_NO_ROAD, yaw.status);
    const int32_t extremes[] = {INT32_MIN, INT32_MIN + 1, -1, 0, 1, INT32_MAX};
    for (int i = 0; i < 6; i++)
        for (int k = 0; k < 6; k++) {
            motion = (roadpose_motion_t){(i & 1) ? 1000 : 10000000, true, true, extremes[k], extremes[i]};
            TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_heading_process(&heading, tracks, 100, &motion, down, &yaw));
        }
}

static void test_one_track_and_equal_tracks(void) {
    good_tracks(1);
    TEST_ASSERT_EQUAL(ROADPOSE_YAW_FEW_TRACKS, process(1).status);
    for (int i = 1; i < 300; i++) tracks[i] = tracks[0];
    TEST_ASSERT_NOT_EQUAL(ROADPOSE_YAW_OK, process(300).status);
    for (int i = 0; i < 300; i++) tracks[i] = (roadpose_track_t){81792, 61312, 81792, 61312};
    TEST_ASSERT_EQUAL(ROADPOSE_YAW_STANDING, process(300).status);
}

static void test_parallel_tracks(void) {
    for (int angle = 0; angle < 16; angle++) {
        for (int i = 0; i < 200; i++) {
            roadpose_track_t *t = &tracks[i];
            t->u0_q8 = (int32_t)random_between(&numbers, 40 * 256, 600 * 256);
            t->v0_q8 = (int32_t)random_between(&numbers, 40 * 256, 440 * 256);
            t->u1_q8 = t->u0_q8 + (int32_t)lround(2560 * cos(angle * 0.3927));
            t->v1_q8 = t->v0_q8 + (int32_t)lround(2560 * sin(angle * 0.3927));
        }
        TEST_ASSERT_NOT_EQUAL(ROADPOSE_YAW_OK, process(200).status);
    }
}

/* All on one line through the focus: it says nothing of where on the line the focus is. */
static void test_tracks_on_one_line(void) {
    for (int i = 0; i < 200; i++) {
        const int32_t x = (i - 100) * 600, d = x / 20;
        tracks[i] = (roadpose_track_t){81792 + x, 61312 + x / 2, 81792 + x + d, 61312 + (x + d) / 2};
    }
    TEST_ASSERT_NOT_EQUAL(ROADPOSE_YAW_OK, process(200).status);
}

static int32_t any_coordinate(void) {
    static const int32_t odd[] = {INT32_MIN, INT32_MIN + 1, -257, -256, -1, 0, 1, 639 * 256, 639 * 256 + 1, 479 * 256,
                                  INT32_MAX - 1, INT32_MAX};
    if (random_bits(&numbers) % 4 == 0) return odd[random_bits(&numbers) % 12];
    return (int32_t)random_between(&numbers, -100, 640 * 256 + 100);
}

static void test_any_coordinates(void) {
    for (int round = 0; round < 3000; round++) {
        const size_t count = (size_t)random_between(&numbers, 0, 600);
        for (size_t i = 0; i < count; i++)
            tracks[i] = (roadpose_track_t){any_coordinate(), any_coordinate(), any_coordinate(), any_coordinate()};
        process(count);
    }
    tracks[0] = (roadpose_track_t){INT32_MIN, INT32_MIN, INT32_MAX, INT32_MAX};
    const roadpose_yaw_t yaw = process(1);
    TEST_ASSERT_EQUAL(1, yaw.dropped_outside);
}

/* Every rig that is allowed, with tracks of any kind in its image. */
static void test_any_rig(void) {
    for (int round = 0; round < 3000; round++) {
        roadpose_rig_t rig = usual_rig();
        rig.focal_millipx = (int32_t)lround(50000 * exp(random_double(&numbers, 0, 4.38)));
        rig.width_px = (uint16_t)random_between(&numbers, 64, ROADPOSE_MAX_WIDTH);
        rig.height_px = (uint16_t)random_between(&numbers, 64, ROADPOSE_MAX_HEIGHT);
        rig.cu_millipx = (int32_t)random_between(&numbers, 0, (rig.width_px - 1) * 1000);
        rig.cv_millipx = (int32_t)random_between(&numbers, 0, (rig.height_px - 1) * 1000);
        TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_heading_init(&heading, &rig, NULL));
        const double zoom = random_double(&numbers, -0.2, 0.2), shake = random_double(&numbers, 0, 3);
        const double cu = random_double(&numbers, 0, rig.width_px), cv = random_double(&numbers, 0, rig.height_px);
        for (int i = 0; i < 150; i++) {
            const double u = random_double(&numbers, 0, rig.width_px - 1), v = random_double(&numbers, 0, rig.height_px - 1);
            const double du = zoom * (u - cu) + shake * random_normal(&numbers);
            const double dv = zoom * (v - cv) + shake * random_normal(&numbers);
            tracks[i] = (roadpose_track_t){(int32_t)(256 * u), (int32_t)(256 * v), (int32_t)(256 * (u + du)),
                                           (int32_t)(256 * (v + dv))};
        }
        process(150);
    }
}

/* 5000 tracks: 256 of them are used, spread over all, and all are counted. */
static void test_too_many_tracks(void) {
    for (int i = 0; i < 5000; i++)
        tracks[i] = i % 2 ? (roadpose_track_t){-1, 0, 0, 0} : (roadpose_track_t){256 * (i % 600), 2560, 256 * (i % 600), 5120};
    const roadpose_yaw_t yaw = process(5000);
    TEST_ASSERT_EQUAL(ROADPOSE_MAX_TRACKS, yaw.tracks_used);
    TEST_ASSERT_EQUAL(2500, yaw.dropped_outside);
    TEST_ASSERT_EQUAL(2500 - ROADPOSE_MAX_TRACKS, yaw.dropped_limit);
}

/* A crowd whose first third is garbage: an even choice keeps enough of the rest. */
static void test_dropped_evenly(void) {
    static simulated_tracks_t simulated;
    const simulated_mount_t mount = {0.02, 0.01, 0.03, 1.5};
    const simulated_step_t step = {1.4, 0, 0.1, 0, 600};
    roadpose_yaw_t yaw;
    int32_t normal[3];
    simulate_tracks(&simulated, &SIMULATED_RIG, &mount, &step, &numbers);
    library_tracks(&simulated, &SIMULATED_RIG, tracks);
    mount_normal_q30(&mount, normal);
    for (int i = 0; i < 200; i++) tracks[i].v1_q8 = (int32_t)random_between(&numbers, 0, 479 * 256);
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_heading_process(&heading, tracks, 600, NULL, normal, &yaw));
    TEST_ASSERT_EQUAL(ROADPOSE_YAW_OK, yaw.status);
    TEST_ASSERT_INT_WITHIN(3500, 30000, yaw.yaw_urad);
    TEST_ASSERT_EQUAL(600 - ROADPOSE_MAX_TRACKS, yaw.dropped_limit + yaw.dropped_outside);
}

/* A frame's yaw does not depend on the frames before it. */
static void test_repeatable(void) {
    static simulated_tracks_t simulated;
    const simulated_mount_t mount = {0.02, 0.01, 0.03, 1.5};
    const simulated_step_t step = {1.2, 0, 0.3, 0.4, 200};
    roadpose_track_t first[SIMULATION_TRACKS_MAX];
    simulate_tracks(&simulated, &SIMULATED_RIG, &mount, &step, &numbers);
    library_tracks(&simulated, &SIMULATED_RIG, first);
    memcpy(tracks, first, 200 * sizeof first[0]);
    const roadpose_yaw_t one = process(200);
    good_tracks(50);
    process(50);
    memcpy(tracks, first, 200 * sizeof first[0]);
    const roadpose_yaw_t two = process(200);
    TEST_ASSERT_EQUAL(one.status, two.status);
    TEST_ASSERT_EQUAL(one.yaw_urad, two.yaw_urad);
    TEST_ASSERT_EQUAL(one.yaw_rate_urad_s, two.yaw_rate_urad_s);
}

static void test_status_words(void) {
    for (int i = 0; i < 256; i++) {
        const char *word = roadpose_yaw_status_word((uint8_t)i);
        TEST_ASSERT_NOT_NULL(word);
        TEST_ASSERT_EQUAL(i >= ROADPOSE_YAW_STATUS_COUNT, strcmp(word, "unknown") == 0);
    }
}

int main(void) {
    numbers = random_numbers("heading, bad input");
    UNITY_BEGIN();
    RUN_TEST(test_null_and_order);
    RUN_TEST(test_rigs);
    RUN_TEST(test_settings);
    RUN_TEST(test_motion_and_normal);
    RUN_TEST(test_one_track_and_equal_tracks);
    RUN_TEST(test_parallel_tracks);
    RUN_TEST(test_tracks_on_one_line);
    RUN_TEST(test_any_coordinates);
    RUN_TEST(test_any_rig);
    RUN_TEST(test_too_many_tracks);
    RUN_TEST(test_dropped_evenly);
    RUN_TEST(test_repeatable);
    RUN_TEST(test_status_words);
    return UNITY_END();
}
