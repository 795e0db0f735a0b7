/* The parts of the yaw estimator against double precision. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "drive_simulation.h"
#include "heading/flow_field.h"
#include "heading/normal_equations.h"
#include "heading/running_yaw.h"
#include "heading/yaw_angle.h"
#include "unity.h"

static random_numbers_t numbers;

void setUp(void) {}
void tearDown(void) {}

static double uniform(double low, double high) { return random_double(&numbers, low, high); }

/* Within the proved ranges the length is never more than 3 % short and 7 % long. */
static void test_length(void) {
    for (int i = 0; i < 100000; i++) {
        const int32_t x = (int32_t)random_between(&numbers, -(1 << 28), 1 << 28);
        const int32_t y = (int32_t)((double)x * tan(uniform(-1.5, 1.5)) * 0.05);
        const double length = hypot(x, y), got = roadpose_length(x, y);
        TEST_ASSERT_TRUE(got >= 0.97 * length - 2 && got <= 1.07 * length + 2);
    }
}

static void turn_flow(double x, double y, const double w[3], int32_t flow[2]) {
    const roadpose_turn_terms_t terms = roadpose_turn_terms((int32_t)lround(ldexp(x, 16)), (int32_t)lround(ldexp(y, 16)));
    const int32_t turn[3] = {(int32_t)lround(ldexp(w[0], 28)), (int32_t)lround(ldexp(w[1], 28)), (int32_t)lround(ldexp(w[2], 28))};
    roadpose_turn_flow(&terms, turn, flow);
}

/* x and y are cut to q13: 2^-13 times |turn| <= 1/2 times the slopes of the terms, 2 |x| + |y| + 1 <= 7, twice: 4000 in q22. */
static void test_flow_of_a_rotation(void) {
    for (int i = 0; i < 100000; i++) {
        const double x = uniform(-2, 2), y = uniform(-2, 2);
        const double w[3] = {uniform(-0.5, 0.5), uniform(-0.5, 0.5), uniform(-0.5, 0.5)};
        int32_t flow[2];
        turn_flow(x, y, w, flow);
        const double du = x * y * w[0] - (1 + x * x) * w[1] + y * w[2];
        const double dv = (1 + y * y) * w[0] - x * y * w[1] - x * w[2];
        TEST_ASSERT_TRUE(fabs(ldexp(du, 22) - flow[0]) <= 4000 && fabs(ldexp(dv, 22) - flow[1]) <= 4000);
    }
}

/* The rotation's flow is that of turning the camera: a point seen through R(-w). */
static void test_flow_is_that_of_a_turning_camera(void) {
    const double w[3] = {0, 1e-4, 0}, x = 0.3, y = -0.2;
    int32_t flow[2];
    turn_flow(x, y, w, flow);
    const double z = x * sin(w[1]) + cos(w[1]); /* the axis turns to the right (x): the point moves to the left */
    TEST_ASSERT_DOUBLE_WITHIN(8, ldexp((x * cos(w[1]) - sin(w[1])) / z - x, 22), flow[0]);
    TEST_ASSERT_DOUBLE_WITHIN(8, ldexp(y / z - y, 22), flow[1]);
}

typedef struct {
    double h[5][5], g[5];
} double_sums_t;

/* Rows as they come: the focus' columns a tenth of the others, and much like those of the rotation. */
static void random_problem(roadpose_sums_t *sums, double_sums_t *reference, const double truth[5]) {
    memset(sums, 0, sizeof *sums);
    memset(reference, 0, sizeof *reference);
    for (int i = 0; i < 150; i++) {
        double row[5], e = 0;
        int32_t j[5];
        for (int k = 2; k < 5; k++) row[k] = uniform(-1.2, 1.2);
        row[0] = 16 * (0.03 * row[4] + uniform(-0.03, 0.03));
        row[1] = 16 * (0.03 * row[2] + uniform(-0.03, 0.03));
        for (int k = 0; k < 5; k++) {
            j[k] = (int32_t)lround(ldexp(row[k], 16));
            e += ldexp(j[k], -16) * truth[k];
        }
        const int32_t e_q22 = (int32_t)lround(ldexp(e, 22)), weight = (int32_t)random_between(&numbers, 0, 256);
        roadpose_sums_add_focus(sums, j, e_q22, weight);
        roadpose_sums_add_turn(sums, j, e_q22, weight);
        for (int r = 0; r < 5; r++) {
            for (int c = 0; c < 5; c++) reference->h[r][c] += weight / 256.0 * ldexp(j[r], -16) * ldexp(j[c], -16);
            reference->g[r] += weight / 256.0 * ldexp(j[r], -16) * ldexp(e_q22, -22);
        }
    }
}

/* Gauss and Jordan; h becomes its inverse. */
static void invert(double h[5][5], int n) {
    double inverse[5][5] = {{0}};
    for (int i = 0; i < n; i++) inverse[i][i] = 1;
    for (int p = 0; p < n; p++) {
        const double pivot = h[p][p];
        for (int c = 0; c < n; c++) h[p][c] /= pivot, inverse[p][c] /= pivot;
        for (int r = 0; r < n; r++) {
            const double factor = h[r][p];
            if (r == p) continue;
            for (int c = 0; c < n; c++) h[r][c] -= factor * h[p][c], inverse[r][c] -= factor * inverse[p][c];
        }
    }
    memcpy(h, inverse, sizeof inverse);
}

/* The solution keeps 34 of the sums' bits: a few 1e-7 of the largest unknown at these conditions. */
static void test_solution(void) {
    for (int i = 0; i < 500; i++) {
        const double truth[5] = {uniform(-0.05, 0.05), uniform(-0.05, 0.05), uniform(-0.05, 0.05), uniform(-0.05, 0.05),
                                 uniform(-0.05, 0.05)};
        roadpose_sums_t sums;
        roadpose_factors_t factors;
        double_sums_t reference;
        int32_t x[5];
        random_problem(&sums, &reference, truth);
        TEST_ASSERT_TRUE(roadpose_factorise(&sums, 5, &factors));
        roadpose_solve(&factors, x);
        for (int k = 0; k < 5; k++) TEST_ASSERT_DOUBLE_WITHIN(2e-6, truth[k], ldexp(x[k], -28));
    }
}

/* Deviations and significance against the inverse in double precision: 1 % is plenty for a gate. */
static void test_spread(void) {
    const int32_t c[5] = {65536, 0, 0, 0, 0}, noise = 4000;
    const double truth[5] = {0.01, 0, 0, 0, 0.002};
    for (int i = 0; i < 500; i++) {
        roadpose_sums_t sums;
        roadpose_factors_t factors;
        double_sums_t reference, block;
        random_problem(&sums, &reference, truth);
        TEST_ASSERT_TRUE(roadpose_factorise(&sums, 5, &factors));
        block = reference;
        invert(reference.h, 5);
        invert(block.h, 2);
        TEST_ASSERT_DOUBLE_WITHIN(2 + 0.01 * noise * sqrt(reference.h[0][0]), noise * sqrt(reference.h[0][0]),
                                  roadpose_deviation(&factors, 5, c, noise));
        TEST_ASSERT_DOUBLE_WITHIN(2 + 0.01 * noise * sqrt(block.h[0][0]), noise * sqrt(block.h[0][0]),
                                  roadpose_deviation(&factors, 2, c, noise));
        const int32_t turn[3] = {0, 0, (int32_t)ldexp(0.002, 28)};
        double marginal[5][5] = {{0}};
        for (int r = 0; r < 3; r++)
            for (int k = 0; k < 3; k++) marginal[r][k] = reference.h[r + 2][k + 2];
        invert(marginal, 3);
        const double expected = 0.002 * 0.002 * marginal[2][2] / ldexp((double)noise * noise, -44);
        TEST_ASSERT_DOUBLE_WITHIN(0.5 + 0.05 * expected, expected,
                                  (double)roadpose_turn_significance(&factors, turn, noise) / 256);
    }
}

/* When the rotation is changed, the focus follows as if it were solved for anew. */
static void test_follow(void) {
    const double truth[5] = {0.01, -0.02, 0.003, 0.001, -0.004};
    roadpose_sums_t sums;
    roadpose_factors_t factors;
    double_sums_t reference;
    const int32_t turn[3] = {-(int32_t)ldexp(truth[2], 28), -(int32_t)ldexp(truth[3], 28), -(int32_t)ldexp(truth[4], 28)};
    int32_t x[5], moved[2];
    random_problem(&sums, &reference, truth);
    TEST_ASSERT_TRUE(roadpose_factorise(&sums, 5, &factors));
    roadpose_solve(&factors, x);
    roadpose_follow(&factors, turn, moved);
    invert(reference.h, 2);
    for (int k = 0; k < 2; k++) {
        const double alone = reference.h[k][0] * reference.g[0] + reference.h[k][1] * reference.g[1];
        TEST_ASSERT_DOUBLE_WITHIN(1e-5, alone, ldexp((double)x[k] + moved[k], -28));
    }
}

static void test_unknowns_that_cannot_be_told_apart(void) {
    const int32_t row[5] = {40000, 20000, 50000, 30000, 60000};
    roadpose_sums_t sums;
    roadpose_factors_t factors;
    memset(&sums, 0, sizeof sums);
    TEST_ASSERT_FALSE(roadpose_factorise(&sums, 2, &factors));
    for (int i = 0; i < 100; i++) {
        roadpose_sums_add_focus(&sums, row, 100, 256);
        roadpose_sums_add_turn(&sums, row, 100, 256);
    }
    TEST_ASSERT_FALSE(roadpose_factorise(&sums, 2, &factors));
    TEST_ASSERT_FALSE(roadpose_factorise(&sums, 5, &factors));
}

/* 3 urad: the normal's and the focus' last bits, and CORDIC's. */
static void test_yaw_and_pitch_angles(void) {
    for (int i = 0; i < 20000; i++) {
        const simulated_mount_t mount = {uniform(-0.4, 0.4), uniform(-0.5, 0.5), uniform(-0.35, 0.35), 1.5};
        const double f = 500;
        double focus[2], normal[3];
        int32_t q24[2], n[3];
        mount_focus(&mount, f, focus);
        if (fabs(focus[0]) >= f || fabs(focus[1]) >= f) continue;
        mount_normal(&mount, normal);
        mount_normal_q30(&mount, n);
        for (int k = 0; k < 2; k++) q24[k] = (int32_t)lround(ldexp(focus[k] / f, 24));
        TEST_ASSERT_INT_WITHIN(3, lround(1e6 * mount.yaw), roadpose_yaw_angle(q24, n));
        TEST_ASSERT_INT_WITHIN(3, 0, roadpose_descent(q24, n));
        TEST_ASSERT_INT_WITHIN(3, lround(1e6 * asin(normal[2])), roadpose_pitch_of_normal(n));
        TEST_ASSERT_TRUE(roadpose_is_unit(n));
    }
    const int32_t no_units[][3] = {{0, 0, 0}, {0, 1 << 29, 0}, {0, 1041529569, 0}, {INT32_MIN, INT32_MIN, INT32_MIN}, {INT32_MAX, 0, 0}};
    for (int i = 0; i < 5; i++) TEST_ASSERT_FALSE(roadpose_is_unit(no_units[i])); /* the third: 3 % short */
}

/* The mean of what is remembered, wherever the history begins; a tenth of wild values does not move it. */
static void test_running_yaw(void) {
    static roadpose_heading_t heading;
    memset(&heading, 0, sizeof heading);
    double sum = 0;
    int kept = 0;
    for (int i = 0; i < 300; i++) {
        roadpose_yaw_t yaw = {.status = ROADPOSE_YAW_OK, .sigma_urad = 1000};
        const bool wild = i % 10 == 9;
        yaw.yaw_urad = wild ? 100000 : (int32_t)lround(8000 + 1000 * random_normal(&numbers));
        if (!wild && i >= 300 - ROADPOSE_YAW_HISTORY) sum += yaw.yaw_urad, kept++;
        roadpose_running_add(&heading, &yaw);
    }
    TEST_ASSERT_DOUBLE_WITHIN(200, sum / kept, heading.running.yaw_urad);
    TEST_ASSERT_INT_WITHIN(400, 1100, heading.running.spread_urad);
    TEST_ASSERT_EQUAL(ROADPOSE_YAW_HISTORY, heading.running.count);
    TEST_ASSERT_EQUAL(300, heading.running.accepted);
}

/* A free rotation that would change every frame alike is believed; one that scatters about nothing is not. Frames of 8000
 * urad; the free fit scatters by 2000, so 64 frames tell its mean to 250. */
static double yaw_with_free_fits(double mean_urad) {
    static roadpose_heading_t heading;
    memset(&heading, 0, sizeof heading);
    for (int i = 0; i < ROADPOSE_YAW_HISTORY; i++) {
        const roadpose_yaw_t yaw = {.status = ROADPOSE_YAW_OK, .sigma_urad = 1000, .yaw_urad = 8000};
        heading.free_urad = (int32_t)lround(mean_urad + (i & 1 ? 2000 : -2000));
        roadpose_running_add(&heading, &yaw);
    }
    return heading.running.yaw_urad;
}

static void test_running_yaw_believes_a_common_rotation(void) {
    TEST_ASSERT_EQUAL(8000, yaw_with_free_fits(0));
    TEST_ASSERT_EQUAL(8000, yaw_with_free_fits(700));
    TEST_ASSERT_DOUBLE_WITHIN(150, 12000 - 140, yaw_with_free_fits(4000)); /* less 9 * 250^2 / 4000 */
    TEST_ASSERT_DOUBLE_WITHIN(150, 4000 + 140, yaw_with_free_fits(-4000));
    /* At most a degree of one frame counts. */
    TEST_ASSERT_DOUBLE_WITHIN(10, 8000 + 17453, yaw_with_free_fits(1000000));
}

static void test_running_yaw_counts_refusals(void) {
    static roadpose_heading_t heading;
    const roadpose_yaw_t slow = {.status = ROADPOSE_YAW_SLOW};
    memset(&heading, 0, sizeof heading);
    roadpose_running_add(&heading, &slow);
    TEST_ASSERT_EQUAL(1, heading.running.refused[ROADPOSE_YAW_SLOW]);
    TEST_ASSERT_EQUAL(0, heading.running.count);
    roadpose_running_clear(&heading);
    TEST_ASSERT_EQUAL(0, heading.running.refused[ROADPOSE_YAW_SLOW]);
}

int main(void) {
    numbers = random_numbers("heading units");
    UNITY_BEGIN();
    RUN_TEST(test_length);
    RUN_TEST(test_flow_of_a_rotation);
    RUN_TEST(test_flow_is_that_of_a_turning_camera);
    RUN_TEST(test_solution);
    RUN_TEST(test_spread);
    RUN_TEST(test_follow);
    RUN_TEST(test_unknowns_that_cannot_be_told_apart);
    RUN_TEST(test_yaw_and_pitch_angles);
    RUN_TEST(test_running_yaw);
    RUN_TEST(test_running_yaw_believes_a_common_rotation);
    RUN_TEST(test_running_yaw_counts_refusals);
    return UNITY_END();
}
