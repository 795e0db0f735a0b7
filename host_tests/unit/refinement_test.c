/* The sums of the refinement and its step against the same least squares in doubles. */
#include "road/refinement.h"

#include <stdlib.h>
#include <string.h>

#include "lsb.h"
#include "random_numbers.h"
#include "roadpose/roadpose.h"
#include "rows.h"

enum { COLUMNS = 160, ROWS = 240, LAST_ROUND = ROADPOSE_REFINE_ROUNDS - 1 };

static random_numbers_t numbers;
static roadpose_points_t points;
static roadpose_moments_t moments;
static roadpose_grid_t grid;
static roadpose_settings_t settings;
static roadpose_plane_t plane;
static double plane_a, plane_b, plane_c; /* pixels per grid step: the truth */

void setUp(void) {
    const roadpose_grid_t street = {COLUMNS, ROWS, 80, 120, 500, -500, 500000, 300000};
    numbers = random_numbers("refinement");
    grid = street;
    roadpose_settings_default(&settings);
}

void tearDown(void) {}

static double truth_at(int column, int row) { return plane_a * (column - 80) + plane_b * (row - 120) + plane_c; }

static void paint(double noise, int strays) {
    roadpose_thinning_t thinning;
    uint16_t row_q8[COLUMNS];
    roadpose_thinning_begin(&thinning, ROADPOSE_MAX_POINTS, COLUMNS * ROWS);
    roadpose_points_clear(&points);
    for (int16_t row = 0; row < ROWS; row++) {
        for (int i = 0; i < COLUMNS; i++) {
            double d = truth_at(i, row) + noise * random_normal(&numbers);
            if (random_between(&numbers, 0, 99) < strays) d = random_double(&numbers, 0.1, ROADPOSE_MAX_DISPARITY);
            const bool kept = d > 0.1 && d < ROADPOSE_MAX_DISPARITY && random_between(&numbers, 0, 5) == 0;
            row_q8[i] = (uint16_t)(kept ? 256 * d : 0);
        }
        add_points(&points, row_q8, COLUMNS, row, &thinning);
    }
}

static void random_start(double off) {
    plane_b = random_double(&numbers, 0.25, 0.7);
    plane_a = plane_b * random_double(&numbers, -0.8, 0.8);
    plane_c = random_double(&numbers, 0, 30);
    plane.a_q24 = (int32_t)ldexp(plane_a + random_double(&numbers, -off, off) / 80, 24);
    plane.b_q24 = (int32_t)ldexp(plane_b + random_double(&numbers, -off, off) / 120, 24);
    plane.c_q24 = (int64_t)ldexp(plane_c + random_double(&numbers, -off, off), 24);
}

static void look(uint8_t round) {
    roadpose_road_rule_t rule;
    TEST_ASSERT_TRUE(roadpose_road_rule(&rule, &plane, &grid, &settings, round));
    rule.mark_corridor = true;
    roadpose_moments_begin(&moments, &rule);
    for (int16_t row = 0; row < ROWS; row++) roadpose_moments_add_row(&moments, &points, &plane, &rule, &grid, row);
}

/* The plane's disparity at a point, Q8, rounded to the nearest; a and the middle of the row are brought to Q18 before,
 * which costs at most 2^-19 px a grid step and 2^-18 px. Exact in doubles. */
static double predicted_q8(int x, int y) {
    const double a_q18 = floor(plane.a_q24 / 64.0 + 0.5), middle = (double)plane.b_q24 * y + (double)plane.c_q24;
    const double cut = floor(ldexp(a_q18 * x + floor((middle + 32768) / 64), -10));
    const double whole = ldexp((double)plane.a_q24 * x + middle, -16);
    ASSERT_LSB(0.5 + ldexp(2 + abs(x), -11), whole, cut, "the plane along a row");
    return cut;
}

typedef struct {
    double n, x, y, xx, xy, yy, r, xr, yr, rr;
    int on_road, off;
} sums_t;

/* With no corridor every point that the plane predicts within the histogram counts in full (weight 2). */
static sums_t reference_sums(double band_q8, double unevenness) {
    sums_t s = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    for (int row = 0; row < ROWS; row++)
        for (unsigned k = points.row_start[row]; k < points.row_start[row + 1]; k++) {
            const double x = roadpose_point_column(points.column[k]) - 80, y = row - 120;
            const double p = predicted_q8((int)x, (int)y), r = points.disparity_q8[k] - p;
            if (p < 1 || p >= ROADPOSE_MAX_DISPARITY * 256.0) continue;
            const double middle = floor(p / 256) * 256 + 128; /* of the distance: it has one band */
            const double wider = moments.level[(int)p / 256].uneven ? floor(middle * unevenness) : 0;
            if (fabs(r) > band_q8 + wider || fabs(r) > 1023) {
                s.off++;
                continue;
            }
            s.on_road++;
            s.n += 2, s.x += 2 * x, s.y += 2 * y, s.xx += 2 * x * x, s.xy += 2 * x * y, s.yy += 2 * y * y;
            s.r += 2 * r, s.xr += 2 * x * r, s.yr += 2 * y * r, s.rr += 2 * r * r;
        }
    return s;
}

static void check_sums(const sums_t *s) {
    TEST_ASSERT_EQUAL(s->on_road, moments.on_road);
    TEST_ASSERT_EQUAL(s->off, moments.above + moments.below + moments.uneven);
    const double expected[] = {s->n, s->x, s->y, s->xx, s->xy, s->yy, s->r, s->xr, s->yr, s->rr};
    const int64_t actual[] = {moments.n,  moments.x, moments.y,  moments.xx, moments.xy,
                              moments.yy, moments.r, moments.xr, moments.yr, moments.rr};
    for (int i = 0; i < 10; i++) ASSERT_LSB(0, expected[i], (double)actual[i], "sum"); /* whole numbers: exact */
}

static void test_sums(void) {
    settings.corridor_half_width_mm = 0;
    settings.corridor_range_mm = 0;
    settings.unevenness_mm = 0;
    for (int n = 0; n < 30; n++) {
        random_start(0.3);
        paint(0.3, 15);
        roadpose_levels_open(&moments);
        look(LAST_ROUND);
        const sums_t s = reference_sums(floor(settings.noise_millipx * 256 / 1000.0), 0);
        check_sums(&s);
    }
}

/* k = B / h on the pixel grid; unevenness / h = unevenness * k / B */
static double share_of(double unevenness_m) {
    const double a = plane_a / ROADPOSE_COLUMN_STEP, b = plane_b / ROADPOSE_ROW_STEP, c = plane_c / 500;
    return unevenness_m * sqrt(a * a + b * b + c * c) / 0.3;
}

/* Points on road with a wider band where the road may be uneven: the share is right to 1/2^16, so the count may differ
 * by the few points that lie on the very edge of the band. */
static void test_unevenness_widens_the_band(void) {
    settings.corridor_half_width_mm = 0;
    settings.corridor_range_mm = 0;
    settings.unevenness_mm = 50;
    random_start(0);
    paint(1.5, 0);
    roadpose_levels_open(&moments);
    look(LAST_ROUND);
    const sums_t s = reference_sums(153, share_of(0.05)), narrow = reference_sums(153, 0);
    ASSERT_LSB(0.002 * s.on_road + 3, s.on_road, moments.on_road, "points on the road");
    TEST_ASSERT_TRUE(s.on_road > narrow.on_road * 1.05);
}

/* A road as flat as its noise keeps the narrow band: what lies beside it are strays. One that is rougher widens it. */
static int uneven_levels_of(double noise, int *seen) {
    int uneven = 0;
    *seen = 0;
    random_start(0);
    paint(noise, 5);
    roadpose_levels_open(&moments);
    look(LAST_ROUND);
    roadpose_levels_judge(&moments, &settings);
    for (int level = 0; level < ROADPOSE_MAX_DISPARITY; level++) {
        const int near = moments.level[level].on + moments.level[level].off;
        *seen += near > 4;
        uneven += near > 4 && moments.level[level].uneven;
    }
    return uneven;
}

static void test_only_an_uneven_road_widens_the_band(void) {
    settings.corridor_half_width_mm = 0;
    settings.corridor_range_mm = 0;
    settings.unevenness_mm = 200;
    for (int n = 0; n < 10; n++) {
        int seen;
        const int flat = uneven_levels_of(0.1, &seen);
        TEST_ASSERT_TRUE(flat * 10 < seen);
        for (int level = 0; level < ROADPOSE_MAX_DISPARITY; level++) moments.level[level].open = true;
        look(LAST_ROUND);
        const sums_t s = reference_sums(153, share_of(0.2));
        ASSERT_LSB(0.002 * s.on_road + 3, s.on_road, moments.on_road, "points on the road");
        const int rough = uneven_levels_of(0.6, &seen);
        TEST_ASSERT_TRUE(rough * 2 > seen);
    }
}

/* Sideways along the road from the point below the camera: full weight within 7/8 of the half width, none beyond 9/8. */
static void test_corridor_weights(void) {
    settings.corridor_half_width_mm = 2000;
    settings.corridor_range_mm = 25000;
    for (int n = 0; n < 20; n++) {
        random_start(0);
        paint(0.05, 0);
        roadpose_levels_open(&moments);
        look(LAST_ROUND);
        const double a = plane_a / ROADPOSE_COLUMN_STEP, b = plane_b / ROADPOSE_ROW_STEP;
        const double c = (plane_c - a * 0.5 + b * 0.5) / 500; /* du, dv: half a pixel */
        const double k = sqrt(a * a + b * b + c * c), n_x = a / k, height = 0.3 / k;
        for (int row = 0; row < ROWS; row++)
            for (unsigned i = points.row_start[row]; i < points.row_start[row + 1]; i++) {
                const int column = roadpose_point_column(points.column[i]), weight = roadpose_point_weight(points.column[i]);
                const double d = truth_at(column, row), px = (column - 80) * ROADPOSE_COLUMN_STEP + 0.5;
                const double sideways = fabs(px * 0.3 / d - n_x * height) / sqrt(1 - n_x * n_x), ahead = 150 / d;
                const bool clear = fabs(ahead - 25) > 0.3 && fabs(sideways - 1.75) > 0.02 && fabs(sideways - 2.25) > 0.02;
                if (d < 0.5 || d > ROADPOSE_MAX_DISPARITY - 1 || !clear) continue;
                const int expected = ahead > 25 || sideways > 2.25 ? 0 : sideways < 1.75 ? 2 : 1;
                TEST_ASSERT_EQUAL(expected, weight);
            }
    }
}

/* Solves the same normal equations by elimination. */
static void reference_step(const roadpose_moments_t *m, double step[3]) {
    double e[3][4] = {{(double)m->xx, (double)m->xy, (double)m->x, (double)m->xr / 256},
                      {(double)m->xy, (double)m->yy, (double)m->y, (double)m->yr / 256},
                      {(double)m->x, (double)m->y, (double)m->n, (double)m->r / 256}};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const double factor = e[j][i] / e[i][i];
            for (int k = 0; j != i && k < 4; k++) e[j][k] -= factor * e[i][k];
        }
    for (int i = 0; i < 3; i++) step[i] = e[i][3] / e[i][i];
}

/* The products are cut to 30 bits: 2^-29 of the largest moment. The slopes' equations are no worse conditioned than
 * about 1 : 2^8 here, so a step of 2^20 LSB (1/16 px a grid step) is right to 1 LSB; c is 100 grid steps away. */
static void test_step(void) {
    for (int n = 0; n < 60; n++) {
        double step[3];
        bool roll_observed = false;
        random_start(0.5);
        paint(0.3, 10);
        roadpose_levels_open(&moments);
        look(n % 2 ? LAST_ROUND : 0);
        const roadpose_plane_t before = plane;
        reference_step(&moments, step);
        TEST_ASSERT_TRUE(roadpose_refine_step(&moments, &plane, &roll_observed));
        TEST_ASSERT_TRUE(roll_observed);
        ASSERT_LSB(2, ldexp(step[0], 24), plane.a_q24 - before.a_q24, "step of a");
        ASSERT_LSB(2, ldexp(step[1], 24), plane.b_q24 - before.b_q24, "step of b");
        ASSERT_LSB(250, ldexp(step[2], 24), (double)(plane.c_q24 - before.c_q24), "step of c");
    }
}

/* From a start that is half a pixel off, all rounds together end on the truth to the noise's share: 0.2 px over 2000
 * points of which the corridor has some 1000: 0.006 px in the middle; 5 sigma, and the ends move 3 times as much. */
static void test_all_rounds(void) {
    for (int n = 0; n < 30; n++) {
        bool roll_observed = false;
        random_start(0.4);
        paint(0.2, 15);
        roadpose_levels_open(&moments);
        for (uint8_t round = 0; round < ROADPOSE_REFINE_ROUNDS; round++) {
            look(round);
            TEST_ASSERT_TRUE(roadpose_refine_step(&moments, &plane, &roll_observed));
        }
        const double nearest = ROWS - 121, c = ldexp((double)plane.c_q24, -24), b = ldexp(plane.b_q24, -24);
        ASSERT_LSB(0.1, plane_c + plane_b * 60, c + b * 60, "disparity in the middle of the road");
        ASSERT_LSB(0.2, plane_c + plane_b * nearest, c + b * nearest, "disparity of the nearest row");
        TEST_ASSERT_TRUE(roll_observed);
    }
}

static roadpose_moments_t moments_of(double spread_x, double spread_y) {
    roadpose_moments_t m;
    memset(&m, 0, sizeof m);
    for (int i = 0; i < 2000; i++) {
        const int64_t x = llround(spread_x * random_normal(&numbers)), y = llround(spread_y * random_normal(&numbers)) + 60;
        m.n++, m.x += x, m.y += y, m.xx += x * x, m.xy += x * y, m.yy += y * y;
    }
    return m;
}

static void test_roll_needs_points_sideways_and_pitch_points_ahead(void) {
    bool roll_observed = true;
    const roadpose_moments_t narrow = moments_of(20.0 / ROADPOSE_COLUMN_STEP * 0.5, 40);
    random_start(0);
    const int32_t slope_of_the_method = plane.a_q24; /* pitch and height need it: a roll of 0 would bend them */
    TEST_ASSERT_TRUE(roadpose_refine_step(&narrow, &plane, &roll_observed));
    TEST_ASSERT_FALSE(roll_observed);
    TEST_ASSERT_EQUAL_INT32(slope_of_the_method, plane.a_q24);
    const roadpose_moments_t flat = moments_of(40, 0.6);
    TEST_ASSERT_FALSE(roadpose_refine_step(&flat, &plane, &roll_observed));
    const roadpose_moments_t good = moments_of(40, 40);
    TEST_ASSERT_TRUE(roadpose_refine_step(&good, &plane, &roll_observed));
    TEST_ASSERT_TRUE(roll_observed);
    roadpose_moments_t none;
    memset(&none, 0, sizeof none);
    TEST_ASSERT_FALSE(roadpose_refine_step(&none, &plane, &roll_observed));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_sums);
    RUN_TEST(test_unevenness_widens_the_band);
    RUN_TEST(test_only_an_uneven_road_widens_the_band);
    RUN_TEST(test_corridor_weights);
    RUN_TEST(test_step);
    RUN_TEST(test_all_rounds);
    RUN_TEST(test_roll_needs_points_sideways_and_pitch_points_ahead);
    return UNITY_END();
}
