/* Method 2: the sorted points, the pairs, the slope and the intercepts, on clouds whose truth is known. */
#include "road/slope_cloud.h"

#include <stdlib.h>
#include <string.h>

#include "lsb.h"
#include "random_numbers.h"
#include "road/plane_ransac.h"
#include "roadpose/roadpose.h"
#include "rows.h"

enum { COLUMNS = 160, ROWS = 240 };

static random_numbers_t numbers;
static roadpose_points_t points;
static roadpose_cloud_t cloud;
static roadpose_grid_t grid;
static roadpose_plane_box_t box;
static double plane_a, plane_b, plane_c; /* pixels per grid step */

void setUp(void) {
    const roadpose_grid_t street = {COLUMNS, ROWS, 80, 120, 0, 0, 500000, 300000};
    roadpose_settings_t settings;
    numbers = random_numbers("slope cloud");
    grid = street;
    roadpose_settings_default(&settings);
    roadpose_plane_box(&box, &grid, &settings);
}

void tearDown(void) {}

static void random_plane(void) {
    plane_b = random_double(&numbers, 0.25, 0.7);
    plane_a = plane_b * random_double(&numbers, -0.8, 0.8);
    plane_c = random_double(&numbers, 0, 30);
}

/* A road with noise; `strays` of a hundred points are anything. */
static void paint(double noise, int strays) {
    roadpose_thinning_t thinning;
    uint16_t row_q8[COLUMNS];
    roadpose_thinning_begin(&thinning, ROADPOSE_MAX_POINTS, COLUMNS * ROWS);
    roadpose_points_clear(&points);
    for (int16_t row = 0; row < ROWS; row++) {
        for (int i = 0; i < COLUMNS; i++) {
            double d = plane_a * (i - 80) + plane_b * (row - 120) + plane_c + noise * random_normal(&numbers);
            if (random_between(&numbers, 0, 99) < strays) d = random_double(&numbers, 0, ROADPOSE_MAX_DISPARITY);
            const bool kept = d > 1 && d < ROADPOSE_MAX_DISPARITY - 1 && random_between(&numbers, 0, 5) == 0;
            row_q8[i] = (uint16_t)(kept ? 256 * d : 0);
        }
        add_points(&points, row_q8, COLUMNS, row, &thinning);
    }
}

/* The passes may be cut anywhere. */
static void pass(bool counting, uint8_t percent) {
    roadpose_thinning_t thinning;
    roadpose_thinning_begin(&thinning, percent, 100);
    for (uint16_t first = 0, last; first < points.count; first = last) {
        last = (uint16_t)(first + random_between(&numbers, 1, 500));
        if (last > points.count) last = points.count;
        if (counting) roadpose_cloud_count(&cloud, &points, first, last, &thinning);
        else roadpose_cloud_place(&cloud, &points, first, last, &thinning);
    }
}

static void sort_points(uint8_t percent) {
    memset(&cloud, 0x66, sizeof cloud);
    roadpose_cloud_clear(&cloud);
    pass(true, percent);
    roadpose_cloud_places(&cloud);
    pass(false, percent);
}

static void test_sorting(void) {
    for (int percent = 1; percent <= 100; percent += 9) {
        static uint8_t seen[ROADPOSE_MAX_POINTS];
        random_plane();
        paint(0.2, 10);
        sort_points((uint8_t)percent);
        memset(seen, 0, sizeof seen);
        TEST_ASSERT_EQUAL_UINT16(points.count * percent / 100, cloud.used);
        for (unsigned k = 0; k < cloud.used; k++) {
            TEST_ASSERT_TRUE(cloud.order[k] < points.count && !seen[cloud.order[k]]++); /* none twice */
            const unsigned level = points.disparity_q8[cloud.order[k]] / 32u;           /* an eighth of a pixel */
            TEST_ASSERT_TRUE(k == 0 || points.disparity_q8[cloud.order[k - 1]] / 32u <= level);
        }
    }
}

static void draw_pairs(void) {
    uint32_t random = (uint32_t)random_bits(&numbers);
    for (int i = 0; i < ROADPOSE_PAIR_TRIES; i++) roadpose_cloud_try_pair(&cloud, &points, &grid, &random);
}

/* On an exact plane two points that differ by up to half a pixel (and 1/256 for cutting them) lie on it: so must
 * dx and dy. The middle of the pair has the pair's mean disparity. */
static void test_pairs(void) {
    for (int n = 0; n < 20; n++) {
        random_plane();
        paint(0, 0);
        sort_points(100);
        draw_pairs();
        TEST_ASSERT_TRUE(cloud.pairs > ROADPOSE_MAX_PAIRS / 2);
        for (unsigned k = 0; k < cloud.pairs; k++) {
            const double middle = plane_a * cloud.x_sum[k] / 2.0 + plane_b * cloud.y_sum[k] / 2.0 + plane_c;
            TEST_ASSERT_TRUE(fabs(plane_a * cloud.dx[k] + plane_b * cloud.dy[k]) <= 0.5 + 2 / 256.0);
            ASSERT_LSB(1.5, 256 * middle, cloud.level_q8[k], "level of a pair"); /* 1 for each cut, 0.5 for the mean */
            TEST_ASSERT_TRUE(abs(cloud.dx[k]) * ROADPOSE_COLUMN_STEP >= 32);
        }
    }
}

static void test_no_points_and_few_points(void) {
    roadpose_points_clear(&points);
    memset(points.row_start, 0, sizeof points.row_start);
    sort_points(100);
    draw_pairs();
    TEST_ASSERT_EQUAL(0, cloud.pairs);
    random_plane();
    paint(0.1, 0);
    points.count = 1;
    sort_points(100);
    draw_pairs();
    TEST_ASSERT_EQUAL(0, cloud.pairs);
}

/* The slope that least squares through the origin gives for the pairs within three pixel rows of the start. */
static double reference_slope(double start) {
    double xx = 0, xy = 0;
    for (unsigned k = 0; k < cloud.pairs; k++)
        if (fabs(cloud.dy[k] - start * cloud.dx[k]) <= 3.0 / ROADPOSE_ROW_STEP) {
            xx += (double)cloud.dx[k] * cloud.dx[k];
            xy += (double)cloud.dx[k] * cloud.dy[k];
        }
    return xy / xx;
}

static int32_t search_slope(void) {
    uint32_t random = (uint32_t)random_bits(&numbers);
    int32_t slope_q16 = 0, score = 0;
    for (int i = 0; i < ROADPOSE_SLOPE_HYPOTHESES; i++) roadpose_slope_try(&cloud, &box, &random, &slope_q16, &score);
    TEST_ASSERT_TRUE(score > 0);
    return slope_q16;
}

/* 1 LSB: the division cuts. The search must have come near the truth in spite of a fifth of stray points, which spoil
 * more than a third of the pairs, and most of those where the road has few points. */
static void test_slope(void) {
    for (int n = 0; n < 30; n++) {
        random_plane();
        paint(0.2, 20);
        sort_points(100);
        draw_pairs();
        int32_t slope_q16 = search_slope();
        const double expected = reference_slope(ldexp(slope_q16, -16));
        const uint16_t before = cloud.pairs, kept = roadpose_slope_fit(&cloud, &box, &slope_q16);
        ASSERT_LSB(1, ldexp(expected, 16), slope_q16, "slope");
        ASSERT_LSB(0.02, -plane_a / plane_b, ldexp(slope_q16, -16), "slope against the truth");
        TEST_ASSERT_TRUE(kept == cloud.pairs && kept <= before && kept > before / 4);
    }
}

/* Least squares of the level over the intercept, of the pairs within one pixel of the start. */
static void reference_line(const roadpose_plane_t *start, double *b, double *c) {
    double n = 0, t1 = 0, tt = 0, d1 = 0, td = 0;
    for (unsigned k = 0; k < cloud.pairs; k++) {
        const double t = ldexp(cloud.intercept_q9[k], -9), d = cloud.level_q8[k] / 256.0;
        const double on_line = ldexp(start->b_q24, -24) * t + ldexp((double)start->c_q24, -24);
        if (fabs(256 * d - floor(256 * on_line)) > 256) continue;
        n += 1, t1 += t, tt += t * t, d1 += d, td += t * d;
    }
    *b = (n * td - t1 * d1) / (n * tt - t1 * t1);
    *c = (d1 - *b * t1) / n;
}

/* b: the intercepts are cut to 1/32 row and the residuals to 1/256 px: 1/256 px over intercepts that spread by 40 rows
 * are 2^16 / 40 LSB; c: 1/256 px and 1/32 row of it. */
static void test_intercepts(void) {
    for (int n = 0; n < 30; n++) {
        random_plane();
        paint(0.2, 20);
        sort_points(100);
        draw_pairs();
        int32_t slope_q16 = search_slope(), score = 0;
        (void)roadpose_slope_fit(&cloud, &box, &slope_q16);
        uint32_t random = (uint32_t)random_bits(&numbers);
        roadpose_plane_t plane = {0, 0, 0};
        for (int i = 0; i < ROADPOSE_INTERCEPT_HYPOTHESES; i++)
            roadpose_intercept_try(&cloud, &box, slope_q16, &random, &plane, &score);
        TEST_ASSERT_TRUE(score > 0);
        double b, c;
        reference_line(&plane, &b, &c);
        TEST_ASSERT_TRUE(roadpose_intercept_fit(&cloud, slope_q16, &plane) > cloud.pairs / 2);
        ASSERT_LSB(1700, ldexp(b, 24), plane.b_q24, "disparity per row");
        ASSERT_LSB(65536 * 2, ldexp(c, 24), (double)plane.c_q24, "disparity at the principal point");
        ASSERT_LSB(2, -ldexp(plane.b_q24, -16) * slope_q16, plane.a_q24, "disparity per column");
        ASSERT_LSB(0.01, plane_b, ldexp(plane.b_q24, -24), "disparity per row against the truth");
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_sorting);
    RUN_TEST(test_pairs);
    RUN_TEST(test_no_points_and_few_points);
    RUN_TEST(test_slope);
    RUN_TEST(test_intercepts);
    return UNITY_END();
}
