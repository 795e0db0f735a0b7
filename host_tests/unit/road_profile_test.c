/* Method 1: the line in a v-disparity whose truth is known. */
#include "road/road_profile.h"

#include <string.h>

#include "lsb.h"
#include "random_numbers.h"
#include "roadpose/roadpose.h"

enum { ROWS = 240, LEVELS = ROADPOSE_MAX_DISPARITY, DRAWS = 200 };

static random_numbers_t numbers;
static roadpose_v_disparity_t histogram;
static roadpose_grid_t grid;
static roadpose_plane_box_t box;

void setUp(void) {
    const roadpose_grid_t street = {160, ROWS, 80, 120, 0, 0, 500000, 300000};
    roadpose_settings_t settings;
    numbers = random_numbers("road profile");
    grid = street;
    roadpose_settings_default(&settings);
    roadpose_plane_box(&box, &grid, &settings);
    memset(&histogram, 0, sizeof histogram);
}

void tearDown(void) {}

/* Samples of a road d = b y + c with noise, and `strays` single counts anywhere. */
static void paint(double b, double c, double noise, int strays) {
    memset(&histogram, 0, sizeof histogram);
    for (int row = 0; row < ROWS; row++)
        for (int i = 0; i < 40; i++) {
            const double d = b * (row - grid.row_0) + c + noise * random_normal(&numbers);
            if (b * (row - grid.row_0) + c > 1 && d > 0 && d < LEVELS) histogram.count[row][(int)d]++;
        }
    for (int i = 0; i < strays; i++)
        histogram.count[random_between(&numbers, 0, ROWS - 1)][random_between(&numbers, 0, LEVELS - 1)]++;
}

static bool search(roadpose_plane_t *line) {
    uint32_t random = (uint32_t)random_bits(&numbers);
    int32_t score = 0;
    memset(line, 0, sizeof *line);
    for (int i = 0; i < ROADPOSE_PROFILE_HYPOTHESES; i++)
        roadpose_profile_try(&histogram, &grid, &box, &random, line, &score);
    return score > 0;
}

/* The same sums in doubles: counts at the middle of their levels, within `width` levels of the line, whole bands only. */
static void reference_fit(const roadpose_plane_t *line, int first_level, int width, double *b, double *c) {
    double n = 0, y1 = 0, yy = 0, d1 = 0, yd = 0;
    for (int row = 0; row < ROWS; row++) {
        const double y = row - grid.row_0, at = ldexp(line->b_q24, -24) * y + ldexp((double)line->c_q24, -24);
        const int middle = (int)floor(at);
        if (at < 0 || at >= LEVELS || middle - width < first_level || middle + width >= LEVELS) continue;
        for (int level = middle - width; level <= middle + width; level++) {
            const double count = histogram.count[row][level];
            n += count, y1 += count * y, yy += count * y * y, d1 += count * (level + 0.5), yd += count * y * (level + 0.5);
        }
    }
    *b = (n * yd - y1 * d1) / (n * yy - y1 * y1);
    *c = (d1 - *b * y1) / n;
}

/* The residuals are taken against the line cut to 1/256 px: each is 0...1/256 px too large. In the worst case, which no
 * real line comes near, all rows on one side of the middle are: rows that spread by 60 turn that into 2^16 / 60 LSB of b
 * in Q24; c, two spreads away from their middle, moves by 3 * 2^16. */
static void test_fit_is_least_squares(void) {
    for (int i = 0; i < DRAWS; i++) {
        const double b = random_double(&numbers, 0.2, 0.9), c = random_double(&numbers, -20, 30);
        paint(b, c, 0.2, 500);
        roadpose_plane_t line = {0, (int32_t)ldexp(b * random_double(&numbers, 0.99, 1.01), 24), (int64_t)ldexp(c, 24)};
        const int width = 1 + i % 2;
        double expected_b, expected_c;
        reference_fit(&line, 0, width, &expected_b, &expected_c);
        TEST_ASSERT_TRUE(roadpose_profile_fit(&histogram, &grid, 0, width, &line));
        ASSERT_LSB(1100, ldexp(expected_b, 24), line.b_q24, "slope");
        ASSERT_LSB(3 * 65536, ldexp(expected_c, 24), (double)line.c_q24, "offset");
    }
}

/* Half of all counts on the road: the search must find it; the fit's own error is what the levels allow. */
static void test_search_and_fit_find_the_road(void) {
    for (int i = 0; i < DRAWS; i++) {
        const double b = random_double(&numbers, 0.25, 0.8), c = random_double(&numbers, -15, 25);
        roadpose_plane_t line;
        paint(b, c, 0.2, 4000);
        TEST_ASSERT_TRUE(search(&line));
        for (int round = 0; round < 3; round++)
            TEST_ASSERT_TRUE(roadpose_profile_fit(&histogram, &grid, 0, round == 0 ? 2 : 1, &line));
        ASSERT_LSB(0.01, b, ldexp(line.b_q24, -24), "slope, pixels a row");
        ASSERT_LSB(0.3, c, ldexp((double)line.c_q24, -24), "offset, pixels");
    }
}

static void test_nothing_to_find(void) {
    roadpose_plane_t line;
    TEST_ASSERT_FALSE(search(&line));
    TEST_ASSERT_FALSE(roadpose_profile_fit(&histogram, &grid, 0, 2, &line));
    for (int row = 0; row < ROWS; row++) histogram.count[row][20] = 100; /* a wall */
    TEST_ASSERT_FALSE(search(&line));
}

static void test_levels_beyond_the_range_do_not_count(void) {
    roadpose_plane_t line = {0, (int32_t)ldexp(0.5, 24), 0}, same = line;
    paint(0.5, 0, 0.2, 0);
    TEST_ASSERT_TRUE(roadpose_profile_fit(&histogram, &grid, 6, 1, &line));
    for (int row = 0; row < ROWS; row++) /* what happens below level 6 - 1 must not matter */
        for (int level = 0; level < 5; level++) histogram.count[row][level] = (roadpose_count_t)random_between(&numbers, 0, 90);
    TEST_ASSERT_TRUE(roadpose_profile_fit(&histogram, &grid, 6, 1, &same));
    TEST_ASSERT_EQUAL_INT32(line.b_q24, same.b_q24);
    TEST_ASSERT_TRUE(line.c_q24 == same.c_q24);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_fit_is_least_squares);
    RUN_TEST(test_search_and_fit_find_the_road);
    RUN_TEST(test_nothing_to_find);
    RUN_TEST(test_levels_beyond_the_range_do_not_count);
    return UNITY_END();
}
