/* From the plane on the grid to the pose, against the geometry in doubles. */
#include "road/ground_plane.h"

#include <string.h>

#include "lsb.h"
#include "random_numbers.h"
#include "roadpose/roadpose.h"
#include "synthetic.h"

enum { DRAWS = 50000 };

static random_numbers_t numbers;

void setUp(void) { numbers = random_numbers("ground plane"); }
void tearDown(void) {}

typedef struct {
    roadpose_grid_t grid;
    roadpose_rig_t rig;
    true_pose_t pose;
    true_plane_t pixels; /* about the principal point */
    roadpose_plane_t plane;
} mounting_t;

static true_pose_t random_pose(const roadpose_settings_t *limits) {
    const double degrees = 180e-6 / 3.14159265358979323846;
    const true_pose_t pose = {
        random_double(&numbers, limits->pitch_min_urad, limits->pitch_max_urad) * degrees,
        random_double(&numbers, -limits->roll_max_urad, limits->roll_max_urad) * degrees,
        random_double(&numbers, limits->height_min_um, limits->height_max_um) * 1e-6};
    return pose;
}

static mounting_t random_mounting(const roadpose_settings_t *limits) {
    mounting_t m;
    memset(&m, 0, sizeof m);
    m.rig.focal_millipx = m.grid.focal_millipx = (int32_t)random_between(&numbers, 200000, 4000000);
    m.rig.baseline_um = m.grid.baseline_um = (int32_t)random_between(&numbers, 20000, 2000000);
    m.grid.columns = 160;
    m.grid.rows = 240;
    m.grid.column_0 = 80;
    m.grid.row_0 = 120;
    m.grid.du_millipx = (int32_t)random_between(&numbers, -1000 * ROADPOSE_COLUMN_STEP / 2, 1000 * ROADPOSE_COLUMN_STEP / 2);
    m.grid.dv_millipx = (int32_t)random_between(&numbers, -1000 * ROADPOSE_ROW_STEP / 2, 1000 * ROADPOSE_ROW_STEP / 2);
    m.pose = random_pose(limits);
    m.pixels = true_plane_of(&m.rig, m.pose);
    m.plane.a_q24 = (int32_t)lround(ldexp(m.pixels.a * ROADPOSE_COLUMN_STEP, 24));
    m.plane.b_q24 = (int32_t)lround(ldexp(m.pixels.b * ROADPOSE_ROW_STEP, 24));
    m.plane.c_q24 = llround(ldexp(m.pixels.c + (m.pixels.a * m.grid.du_millipx + m.pixels.b * m.grid.dv_millipx) / 1000, 24));
    return m;
}

/* b, the disparity per grid row, must be in the range that the library proves: below 8 px per px. */
static bool is_proved(const mounting_t *m) { return hypot(m->pixels.a, m->pixels.b) < 7.9 && fabs(m->pixels.c) < 32000; }

static roadpose_settings_t widest_limits(void) {
    roadpose_settings_t limits;
    roadpose_settings_default(&limits);
    limits.pitch_min_urad = -523599;
    limits.pitch_max_urad = 523599;
    limits.roll_max_urad = 610865;
    limits.height_min_um = 200000;
    limits.height_max_um = 5000000;
    return limits;
}

/* a, b: 1 for rounding the grid's slope, as a step is a whole number of pixels; c: the same over up to 8 px; length: 1
 * for the root, 1 each for a, b, c / f. */
static void check_pixels(const mounting_t *m) {
    roadpose_pixel_plane_t out;
    TEST_ASSERT_TRUE(roadpose_plane_to_pixels(&m->plane, &m->grid, &out));
    ASSERT_LSB(1.5, ldexp(m->pixels.a, 24), out.a_q24, "a");
    ASSERT_LSB(1.5, ldexp(m->pixels.b, 24), out.b_q24, "b");
    ASSERT_LSB(12, ldexp(m->pixels.c, 24), (double)out.c_q24, "c");
    ASSERT_LSB(4, ldexp(m->rig.baseline_um * 1e-6 / m->pose.height_m, 24), (double)out.length_q24, "length");
}

/* The pose follows from the plane's parts, each right to about 3 LSB of Q24 of `length`: that is the angle's error, and
 * the height's relative one. 1.5 urad for the arctangent and the root before it. */
static void check_pose(const mounting_t *m) {
    roadpose_pixel_plane_t pixels;
    roadpose_pose_t pose;
    TEST_ASSERT_TRUE(roadpose_plane_to_pixels(&m->plane, &m->grid, &pixels));
    roadpose_plane_pose(&pixels, &m->grid, &pose);
    const double degrees = 180e-6 / 3.14159265358979323846;
    const double part = 4.0 / (double)pixels.length_q24, pitch = m->pose.pitch_deg, roll = m->pose.roll_deg;
    const double radians = degrees * 1e6, tau = atan2(sin(pitch / radians), cos(pitch / radians) * cos(roll / radians));
    ASSERT_LSB(1.5 + 1e6 * part, pitch / degrees, pose.pitch_urad, "pitch");
    ASSERT_LSB(1.5 + 1.2e6 * part, roll / degrees, pose.roll_urad, "roll"); /* n_x, n_y are shorter than n */
    ASSERT_LSB(1.5 + 1.3e6 * part, 1e6 * tau, pose.paper_pitch_urad, "the paper's pitch");
    ASSERT_LSB(1.5 + 1e6 * part, 1e6 * asin(cos(pitch / radians) * sin(roll / radians)), pose.paper_roll_urad,
               "the paper's roll");
    ASSERT_LSB(1 + 1e6 * m->pose.height_m * part, 1e6 * m->pose.height_m, pose.height_um, "height");
    ASSERT_LSB(2 + ldexp(part, 30), ldexp(sin(pitch / radians), 30), pose.normal_q30[2], "normal");
}

static void test_plane_to_pose(void) {
    const roadpose_settings_t limits = widest_limits();
    int checked = 0;
    for (int i = 0; i < DRAWS; i++) {
        const mounting_t m = random_mounting(&limits);
        if (!is_proved(&m)) continue;
        check_pixels(&m);
        check_pose(&m);
        checked++;
    }
    TEST_ASSERT_TRUE(checked > DRAWS / 2);
}

static void test_planes_that_are_none(void) {
    const roadpose_grid_t grid = {160, 240, 80, 120, 0, 0, 500000, 300000};
    const roadpose_plane_t nothing = {0, 0, 0}, steep = {INT32_MAX, 0, 0}, far_off = {0, 1 << 20, INT64_C(1) << 40};
    const roadpose_plane_t behind = {0, 1 << 20, -(INT64_C(1) << 40)}, lowest = {INT32_MIN, INT32_MIN, 0};
    roadpose_pixel_plane_t out;
    TEST_ASSERT_FALSE(roadpose_plane_to_pixels(&nothing, &grid, &out));
    TEST_ASSERT_FALSE(roadpose_plane_to_pixels(&steep, &grid, &out) && ROADPOSE_COLUMN_STEP < 16);
    TEST_ASSERT_FALSE(roadpose_plane_to_pixels(&far_off, &grid, &out));
    TEST_ASSERT_FALSE(roadpose_plane_to_pixels(&behind, &grid, &out));
    TEST_ASSERT_FALSE(roadpose_plane_to_pixels(&lowest, &grid, &out) && ROADPOSE_COLUMN_STEP < 16);
}

static void test_limits_are_inclusive(void) {
    roadpose_settings_t settings;
    roadpose_settings_default(&settings);
    roadpose_pose_t pose;
    memset(&pose, 0, sizeof pose);
    const int32_t pitches[] = {-174534, -174533, 261799, 261800}, rolls[] = {-436333, -436332, 436332, 436333};
    const int32_t heights[] = {299999, 300000, 4000000, 4000001};
    for (int i = 0; i < 64; i++) {
        pose.pitch_urad = pitches[i % 4];
        pose.roll_urad = rolls[i / 4 % 4];
        pose.height_um = heights[i / 16];
        const bool inside = i % 4 % 3 && i / 4 % 4 % 3 && i / 16 % 3;
        TEST_ASSERT_EQUAL(inside, roadpose_pose_within_limits(&pose, &settings));
    }
}

/* The box never rejects a plane that the limits allow. */
static void test_box_holds_all_allowed_planes(void) {
    for (int i = 0; i < DRAWS; i++) {
        roadpose_settings_t limits = widest_limits();
        roadpose_plane_box_t box;
        if (i % 2) roadpose_settings_default(&limits);
        const mounting_t m = random_mounting(&limits);
        roadpose_plane_box(&box, &m.grid, &limits);
        TEST_ASSERT_TRUE(!is_proved(&m) || roadpose_profile_in_box(&m.plane, &box));
        TEST_ASSERT_TRUE(fabs(m.pixels.a / m.pixels.b) * ROADPOSE_COLUMN_STEP / ROADPOSE_ROW_STEP * 65536 <= box.slope_max_q16);
    }
}

/* And it does reject what is far from them: a wall, a plane seen from below, a ceiling. */
static void test_box_rejects_what_is_no_road(void) {
    const roadpose_grid_t grid = {160, 240, 80, 120, 0, 0, 500000, 300000};
    roadpose_settings_t settings;
    roadpose_plane_box_t box;
    roadpose_settings_default(&settings);
    roadpose_plane_box(&box, &grid, &settings);
    const roadpose_plane_t wall = {0, 100, 20 << 24}, ceiling = {0, -(1 << 22), 0}, too_high = {0, 1 << 18, 0};
    const roadpose_plane_t steep = {0, 1 << 22, INT64_C(100) << 24};
    TEST_ASSERT_FALSE(roadpose_profile_in_box(&wall, &box));
    TEST_ASSERT_FALSE(roadpose_profile_in_box(&ceiling, &box));
    TEST_ASSERT_FALSE(roadpose_profile_in_box(&too_high, &box));
    TEST_ASSERT_FALSE(roadpose_profile_in_box(&steep, &box));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_plane_to_pose);
    RUN_TEST(test_planes_that_are_none);
    RUN_TEST(test_limits_are_inclusive);
    RUN_TEST(test_box_holds_all_allowed_planes);
    RUN_TEST(test_box_rejects_what_is_no_road);
    return UNITY_END();
}
