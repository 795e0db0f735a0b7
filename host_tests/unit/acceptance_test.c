/* Which status a plane and its support give, and what a refused pose keeps. */
#include "road/acceptance.h"

#include <string.h>

#include "lsb.h"
#include "roadpose/roadpose.h"
#include "synthetic.h"

static roadpose_moments_t moments;
static roadpose_grid_t grid;
static roadpose_settings_t settings;
static roadpose_plane_t plane;
static roadpose_pose_t pose;

static void set_plane(double pitch_deg, double roll_deg, double height_m) {
    const roadpose_rig_t rig = rig_640x480();
    const true_pose_t truth = {pitch_deg, roll_deg, height_m};
    const true_plane_t true_plane = true_plane_of(&rig, truth);
    plane.a_q24 = (int32_t)ldexp(true_plane.a * ROADPOSE_COLUMN_STEP, 24);
    plane.b_q24 = (int32_t)ldexp(true_plane.b * ROADPOSE_ROW_STEP, 24);
    plane.c_q24 = (int64_t)ldexp(true_plane.c, 24);
}

/* 3000 points on the road at disparities of 6...50 px (25 m to 3 m), residuals of 0.25 px, 500 that disagree. */
void setUp(void) {
    const roadpose_grid_t street = {160, 240, 80, 120, 0, 0, 500000, 300000};
    grid = street;
    roadpose_settings_default(&settings);
    memset(&moments, 0, sizeof moments);
    memset(&pose, 0, sizeof pose);
    for (int level = 6; level <= 50; level++) {
        moments.level[level].open = true;
        moments.level[level].on = 3000 / 45;
    }
    moments.on_road = 3000 / 45 * 45;
    moments.n = 2 * moments.on_road;
    moments.rr = moments.n * 64 * 64;
    moments.above = 500;
    pose.valid_samples = 9000;
    pose.free_samples = 5000;
    set_plane(1.5, -2, 1.4);
}

void tearDown(void) {}

static void judge(bool roll_observed) { roadpose_accept(&pose, &plane, &moments, &grid, &settings, roll_observed); }

static void expect_refused(roadpose_status_t status) {
    judge(true);
    TEST_ASSERT_EQUAL(status, pose.status);
    TEST_ASSERT_EQUAL(0, pose.observed);
    TEST_ASSERT_EQUAL(0, pose.pitch_urad | pose.roll_urad | pose.height_um | pose.normal_q30[2] | pose.plane_v_q24);
    TEST_ASSERT_EQUAL(9000, pose.valid_samples);
    TEST_ASSERT_EQUAL(5000, pose.free_samples);
}

static void test_good_road(void) {
    judge(true);
    TEST_ASSERT_EQUAL(ROADPOSE_STATUS_OK, pose.status);
    TEST_ASSERT_EQUAL(7, pose.observed);
    TEST_ASSERT_INT_WITHIN(20, 26180, pose.pitch_urad);
    TEST_ASSERT_INT_WITHIN(20, -34907, pose.roll_urad);
    TEST_ASSERT_INT_WITHIN(50, 1400000, pose.height_um);
    TEST_ASSERT_EQUAL(moments.on_road, pose.road_points);
    ASSERT_LSB(1, 1000.0 * moments.on_road / (moments.on_road + 500), pose.support_permille, "support");
    ASSERT_LSB(4, 250, pose.residual_millipx, "residual"); /* 1/256 px is 3.9 */
    /* a level is one pixel: half of it either way, and one level for the 64th that may lie beyond */
    ASSERT_LSB(4500, 500 * 300 / 6.5, pose.range_far_mm, "farthest");
    ASSERT_LSB(100, 500 * 300 / 50.5, pose.range_near_mm, "nearest");
}

static void test_roll_that_was_not_observed_is_absent(void) {
    judge(false);
    TEST_ASSERT_EQUAL(ROADPOSE_STATUS_OK, pose.status);
    TEST_ASSERT_EQUAL(ROADPOSE_OBSERVED_PITCH | ROADPOSE_OBSERVED_HEIGHT, pose.observed);
    TEST_ASSERT_EQUAL(0, pose.roll_urad);
    TEST_ASSERT_EQUAL(0, pose.paper_roll_urad);
}

static void test_too_few_points(void) {
    settings.points_min = (uint16_t)moments.on_road;
    judge(true);
    TEST_ASSERT_EQUAL(ROADPOSE_STATUS_OK, pose.status);
    settings.points_min++;
    expect_refused(ROADPOSE_STATUS_LITTLE_SUPPORT);
}

static void test_too_many_that_disagree(void) {
    moments.above = moments.on_road / 2;
    moments.below = moments.on_road / 2;
    judge(true);
    TEST_ASSERT_EQUAL(ROADPOSE_STATUS_OK, pose.status); /* just half agree */
    moments.below += 10;
    expect_refused(ROADPOSE_STATUS_POOR_FIT);
    setUp();
    moments.uneven = moments.on_road;
    expect_refused(ROADPOSE_STATUS_POOR_FIT);
}

static void test_road_that_ends_too_near(void) {
    for (int level = 0; level < 40; level++) moments.level[level].on = 0;
    for (int level = 40; level <= 50; level++) moments.level[level].on = 280;
    moments.on_road = 280 * 11;
    moments.n = 2 * moments.on_road;
    expect_refused(ROADPOSE_STATUS_SHORT_RANGE);
}

static void test_outside_the_mounting_limits(void) {
    const double bad[][3] = {{15.1, 0, 1.5}, {-10.1, 0, 1.5}, {0, 25.1, 1.5}, {0, -25.1, 1.5}, {0, 0, 0.29}, {0, 0, 4.1}};
    for (int i = 0; i < 6; i++) {
        setUp();
        set_plane(bad[i][0], bad[i][1], bad[i][2]);
        expect_refused(ROADPOSE_STATUS_OUTSIDE_LIMITS);
    }
}

static void test_no_points_and_no_plane(void) {
    memset(&moments, 0, sizeof moments);
    judge(true);
    TEST_ASSERT_NOT_EQUAL(ROADPOSE_STATUS_OK, pose.status);
    setUp();
    memset(&plane, 0, sizeof plane);
    judge(true);
    TEST_ASSERT_NOT_EQUAL(ROADPOSE_STATUS_OK, pose.status);
    TEST_ASSERT_EQUAL(0, pose.observed);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_good_road);
    RUN_TEST(test_roll_that_was_not_observed_is_absent);
    RUN_TEST(test_too_few_points);
    RUN_TEST(test_too_many_that_disagree);
    RUN_TEST(test_road_that_ends_too_near);
    RUN_TEST(test_outside_the_mounting_limits);
    RUN_TEST(test_no_points_and_no_plane);
    return UNITY_END();
}
