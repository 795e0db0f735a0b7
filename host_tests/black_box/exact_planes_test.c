/* An endless road and nothing else, its disparities exact up to their rounding to 1/256 px: over the whole range of
 * mountings the pose must come back. Whether a mounting lets enough road be seen is computed here, independently. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "roadpose/roadpose.h"
#include "synthetic.h"
#include "unity.h"

/* Rounding to 1/256 px is an error of 0.0011 px (1 sigma), systematic where a row or column of samples falls on the
 * same fraction. On the rig with the least leverage here (f B = 30 px m, 4 m high, under 3 px from the nearest to the
 * farthest road that counts) 0.0005 px of it left in the mean is 0.01 deg. */
#ifdef ROADPOSE_SMALL_PROFILE
#define ANGLE_TOLERANCE_DEG 0.02 /* a quarter of the samples: the mean is twice as rough */
#else
#define ANGLE_TOLERANCE_DEG 0.01
#endif
#define HEIGHT_TOLERANCE 0.001 /* of the height: the same 0.0005 px against the disparity of the middle of the road */

static const roadpose_rig_t rigs[] = {
    {320, 240, 250000, 160000, 120000, 120000},    {640, 480, 500000, 319500, 239500, 300000},
    {640, 480, 420000, 305200, 260700, 200000},    {1242, 375, 721538, 609559, 172854, 537151},
    {1280, 720, 700000, 640000, 300000, 650000},   {2048, 1536, 1600000, 1023500, 767500, 240000},
    {2048, 1536, 1000000, 1023500, 767500, 400000},
};
static const double rolls[] = {-25, -20, -11, -3, 0, 1, 7, 16, 25};
static const double pitches[] = {-10, -6, -2, 0, 0.5, 4, 9, 15};
static const double heights[] = {0.3, 0.6, 1.2, 1.65, 2.5, 4};
#define RADIANS (3.14159265358979323846 / 180)
#define COUNT(array) ((int)(sizeof(array) / sizeof(array)[0]))

static roadpose_t instance;
static uint16_t *samples;
static int visible, seen_although_little, failures;
static double worst_angle, worst_height;

void setUp(void) {
    samples = malloc(2u * 2048 * 1536);
    TEST_ASSERT_NOT_NULL(samples);
    visible = seen_although_little = failures = 0;
    worst_angle = worst_height = 0;
}

void tearDown(void) { free(samples); }

static bool fits(const roadpose_rig_t *rig) {
    return rig->width_px <= ROADPOSE_MAX_WIDTH && rig->height_px <= ROADPOSE_MAX_HEIGHT;
}

static roadpose_settings_t widest_limits(void) {
    roadpose_settings_t settings;
    roadpose_settings_default(&settings);
    settings.pitch_min_urad = -500000;
    settings.pitch_max_urad = 500000;
    settings.roll_max_urad = 600000;
    settings.height_min_um = 200000;
    settings.height_max_um = 5000000;
    return settings;
}

/* What of the road a mounting shows inside the corridor. */
typedef struct {
    int samples;
    double near_m, far_m, least_x, most_x;
    double rows, squared_rows;
} road_seen_t;

/* Sideways is along the road, from the point straight below the camera. */
static void count_sample(road_seen_t *seen, const roadpose_rig_t *rig, true_pose_t pose, double u, double v, double d) {
    const double n_x = cos(pose.pitch_deg * RADIANS) * sin(pose.roll_deg * RADIANS);
    const double z = rig->focal_millipx * 1e-3 * rig->baseline_um * 1e-6 / d;
    const double camera_x = (u - rig->cu_millipx * 1e-3) * rig->baseline_um * 1e-6 / d;
    const double x = (camera_x - n_x * pose.height_m) / sqrt(1 - n_x * n_x);
    if (z > 25 || fabs(x) > 2) return;
    seen->samples++;
    seen->rows += v;
    seen->squared_rows += v * v;
    seen->near_m = fmin(seen->near_m, z);
    seen->far_m = fmax(seen->far_m, z);
    seen->least_x = fmin(seen->least_x, x);
    seen->most_x = fmax(seen->most_x, x);
}

static road_seen_t road_seen(const roadpose_rig_t *rig, true_pose_t pose) {
    const true_plane_t plane = true_plane_of(rig, pose);
    road_seen_t seen = {0, 1e9, 0, 1e9, -1e9, 0, 0};
    for (int v = 0; v < rig->height_px; v += ROADPOSE_ROW_STEP)
        for (int u = 0; u < rig->width_px; u += ROADPOSE_COLUMN_STEP) {
            const double d = true_disparity_at(rig, plane, u, v);
            if (d > 0.5 && d < ROADPOSE_MAX_DISPARITY - 1) count_sample(&seen, rig, pose, u, v, d);
        }
    return seen;
}

static double row_spread(const road_seen_t *seen) {
    const double mean = seen->rows / seen->samples;
    return sqrt(seen->squared_rows / seen->samples - mean * mean);
}

/* Enough for a pose with margin over the default acceptance (96 points, 5 m, rows that spread by 20 px): four times
 * the points, to 8 m ahead, over a stretch that doubles the distance, 1.5 m wide, rows that spread by 25 px. */
static bool is_visible(const road_seen_t *seen) {
    return seen->samples >= 384 && seen->far_m >= 8 && seen->far_m >= 2 * seen->near_m &&
           seen->most_x - seen->least_x >= 1.5 && row_spread(seen) >= 25;
}

static void fail_case(const char *what, const roadpose_rig_t *rig, true_pose_t pose, double angle, double height) {
    failures++;
    if (failures <= 20)
        printf("%s: rig %dx%d f %.1f B %.3f, pitch %.2f roll %.2f height %.2f; off by %.4f deg, %.4f %%\n", what,
               rig->width_px, rig->height_px, rig->focal_millipx * 1e-3, rig->baseline_um * 1e-6, pose.pitch_deg,
               pose.roll_deg, pose.height_m, angle, 100 * height);
}

/* Where roll was not observed it is no error; the planes of this test that must be seen show it. */
static double roll_error(const roadpose_pose_t *pose, true_pose_t truth, double factor) {
    if (factor > 1 && !(pose->observed & ROADPOSE_OBSERVED_ROLL)) return 0;
    return fabs(pose->roll_urad * 1e-6 / RADIANS - truth.roll_deg);
}

static void compare(const roadpose_rig_t *rig, true_pose_t truth, const roadpose_pose_t *pose, double factor) {
    const double angle =
        fmax(fabs(pose->pitch_urad * 1e-6 / RADIANS - truth.pitch_deg), roll_error(pose, truth, factor));
    const double height = fabs(pose->height_um * 1e-6 - truth.height_m) / truth.height_m;
    worst_angle = fmax(worst_angle, angle);
    worst_height = fmax(worst_height, height);
    if (angle > factor * ANGLE_TOLERANCE_DEG || height > factor * HEIGHT_TOLERANCE)
        fail_case("pose is off", rig, truth, angle, height);
}

static void try_pose(const roadpose_rig_t *rig, true_pose_t truth) {
    const road_seen_t seen = road_seen(rig, truth);
    const bool must = is_visible(&seen);
    roadpose_pose_t pose;
    render_road(rig, truth, 256, samples);
    const roadpose_frame_t frame = frame_of(rig, samples);
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_process(&instance, &frame, &pose));
    if (must && pose.status != ROADPOSE_STATUS_OK) fail_case(roadpose_status_word(pose.status), rig, truth, 0, 0);
    visible += must;
    seen_although_little += !must && pose.status == ROADPOSE_STATUS_OK;
    /* What is accepted with less road than that must still be right, if not as exactly. */
    if (pose.status == ROADPOSE_STATUS_OK) compare(rig, truth, &pose, must ? 1 : 10);
}

/* Every mounting for the images of common size, every fifth for the largest, which take their time to paint. */
static int try_rig(const roadpose_rig_t *rig) {
    const int step = rig->width_px > 1000 ? 5 : 1;
    int tried = 0;
    const roadpose_disparity_format_t format = format_u16_q8();
    const roadpose_settings_t settings = widest_limits();
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_init(&instance, rig, &format, &settings));
    for (int i = 0; i < COUNT(rolls); i++)
        for (int j = 0; j < COUNT(pitches); j++)
            for (int k = (i + j) % step; k < COUNT(heights); k += step, tried++) {
                const true_pose_t truth = {pitches[j], rolls[i], heights[k]};
                try_pose(rig, truth);
            }
    return tried;
}

static void test_every_mounting_that_shows_enough_road(void) {
    int all = 0;
    for (int i = 0; i < COUNT(rigs); i++)
        if (fits(&rigs[i])) all += try_rig(&rigs[i]);
    printf("%d mountings, %d show enough road, %d more were accepted; worst angle %.5f deg, worst height %.5f %%\n", all,
           visible, seen_although_little, worst_angle, 100 * worst_height);
    TEST_ASSERT_EQUAL(0, failures);
    TEST_ASSERT_TRUE(visible > all / 4); /* the test is not empty */
}

/* The paper's pair of the same plane (GEOMETRY: n = (sin rho, cos rho cos tau, cos rho sin tau)), the normal and the
 * plane in disparity space. */
static void test_other_names_of_the_same_plane(void) {
    const roadpose_rig_t rig = rig_640x480();
    const roadpose_disparity_format_t format = format_u16_q8();
    const true_pose_t truth = {4.698, 20.069, 1.5};
    const true_plane_t plane = true_plane_of(&rig, truth);
    roadpose_pose_t pose;
    render_road(&rig, truth, 256, samples);
    const roadpose_frame_t frame = frame_of(&rig, samples);
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_init(&instance, &rig, &format, NULL));
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_process(&instance, &frame, &pose));
    TEST_ASSERT_EQUAL(ROADPOSE_STATUS_OK, pose.status);
    TEST_ASSERT_INT_WITHIN(175, 349066, pose.paper_roll_urad); /* 20 deg; 175 urad = 0.01 deg */
    TEST_ASSERT_INT_WITHIN(175, 87266, pose.paper_pitch_urad); /* 5 deg */
    const double scale = rig.baseline_um * 1e-6 / truth.height_m;
    TEST_ASSERT_INT_WITHIN(187904, (int)lround(ldexp(plane.a / scale, 30)), pose.normal_q30[0]); /* 175 urad */
    TEST_ASSERT_INT_WITHIN(187904, (int)lround(ldexp(plane.b / scale, 30)), pose.normal_q30[1]);
    TEST_ASSERT_INT_WITHIN(187904, (int)lround(ldexp(plane.c / (500 * scale), 30)), pose.normal_q30[2]);
    /* Over the image the plane must be right to 1/64 px: a and b to 1/64 / 640, c to 1/128. */
    TEST_ASSERT_INT_WITHIN(409, (int)lround(ldexp(plane.a, 24)), pose.plane_u_q24);
    TEST_ASSERT_INT_WITHIN(409, (int)lround(ldexp(plane.b, 24)), pose.plane_v_q24);
    TEST_ASSERT_INT_WITHIN(512, (int)lround(ldexp(plane.c, 16)), pose.plane_0_q16);
}

/* A road beside walls: the same pose, and the support figures say how much was road. */
static void test_support_figures(void) {
    const roadpose_rig_t rig = rig_640x480();
    const roadpose_disparity_format_t format = format_u16_q8();
    const true_pose_t truth = {2, -3, 1.5};
    roadpose_pose_t pose;
    render_road(&rig, truth, 256, samples);
    render_wall(&rig, truth, 14, 0, 180, 150, samples);
    render_wall(&rig, truth, 9, 420, 640, 150, samples);
    const roadpose_frame_t frame = frame_of(&rig, samples);
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_init(&instance, &rig, &format, NULL));
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_process(&instance, &frame, &pose));
    TEST_ASSERT_EQUAL(ROADPOSE_STATUS_OK, pose.status);
    compare(&rig, truth, &pose, 1);
    TEST_ASSERT_EQUAL(0, failures);
    const road_seen_t seen = road_seen(&rig, truth);
    TEST_ASSERT_TRUE(pose.road_points <= pose.free_samples && pose.free_samples <= pose.valid_samples);
    TEST_ASSERT_INT_WITHIN(seen.samples / 4 + 10, (seen.samples > ROADPOSE_MAX_POINTS ? ROADPOSE_MAX_POINTS : seen.samples),
                           (int)pose.road_points);
    TEST_ASSERT_TRUE(pose.support_permille >= 900 && pose.support_permille <= 1000);
    TEST_ASSERT_TRUE(pose.residual_millipx <= 10); /* rounding alone is 1.1 */
    TEST_ASSERT_INT_WITHIN(500, (int)(1000 * seen.near_m), (int)pose.range_near_mm);
    /* A 64th of the points may be farther; of a corridor they are few per metre in the distance. */
    TEST_ASSERT_TRUE(pose.range_far_mm >= 12000 && pose.range_far_mm <= 27500);
    TEST_ASSERT_EQUAL(ROADPOSE_OBSERVED_PITCH | ROADPOSE_OBSERVED_ROLL | ROADPOSE_OBSERVED_HEIGHT, pose.observed);
}

static void expect_status(const roadpose_settings_t *settings, true_pose_t truth, roadpose_status_t status) {
    const roadpose_rig_t rig = rig_640x480();
    const roadpose_disparity_format_t format = format_u16_q8();
    roadpose_pose_t pose;
    render_road(&rig, truth, 256, samples);
    const roadpose_frame_t frame = frame_of(&rig, samples);
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_init(&instance, &rig, &format, settings));
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_process(&instance, &frame, &pose));
    if (status == ROADPOSE_STATUS_OK) {
        TEST_ASSERT_EQUAL(ROADPOSE_STATUS_OK, pose.status);
        return;
    }
    /* Just outside the limits the word may be either: no road within the limits, or a plane outside them. */
    TEST_ASSERT_TRUE(pose.status == ROADPOSE_STATUS_OUTSIDE_LIMITS || pose.status == ROADPOSE_STATUS_NO_ROAD);
    TEST_ASSERT_EQUAL(0, pose.observed);
    TEST_ASSERT_EQUAL(0, pose.pitch_urad | pose.roll_urad | pose.height_um | pose.paper_pitch_urad |
                             pose.paper_roll_urad | pose.normal_q30[0] | pose.normal_q30[1] | pose.normal_q30[2] |
                             pose.plane_u_q24 | pose.plane_v_q24 | pose.plane_0_q16);
}

static void test_mounting_limits(void) {
    const struct { true_pose_t inside, outside; } cases[] = {
        {{14.9, 0, 1.5}, {15.2, 0, 1.5}}, {{-9.9, 0, 1.5}, {-10.2, 0, 1.5}}, {{0, 24.9, 1.5}, {0, 25.2, 1.5}},
        {{0, -24.9, 1.5}, {0, -25.2, 1.5}}, {{5, 0, 3.95}, {5, 0, 4.1}}, {{0, 0, 0.32}, {0, 0, 0.28}},
    };
    for (int i = 0; i < COUNT(cases); i++) {
        expect_status(NULL, cases[i].inside, ROADPOSE_STATUS_OK);
        expect_status(NULL, cases[i].outside, ROADPOSE_STATUS_OUTSIDE_LIMITS);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_every_mounting_that_shows_enough_road);
    RUN_TEST(test_other_names_of_the_same_plane);
    RUN_TEST(test_support_figures);
    RUN_TEST(test_mounting_limits);
    return UNITY_END();
}
