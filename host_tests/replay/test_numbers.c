/* Number formats of roadpose-replay: decimals in, degrees and metres out, against plain double precision. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "csv.h"
#include "decimal.h"
#include "unity.h"

#define DEGREES (180.0 / 3.14159265358979323846)

void setUp(void) {
}

void tearDown(void) {
}

static void assert_parsed(const char *text, int places, int64_t scaled, bool is_exact) {
    decimal_t number = {-1, false};

    TEST_ASSERT_TRUE_MESSAGE(decimal_parse(text, places, &number), text);
    TEST_ASSERT_EQUAL_INT64_MESSAGE(scaled, number.scaled, text);
    TEST_ASSERT_EQUAL_INT_MESSAGE(is_exact, number.is_exact, text);
}

static void test_exact_numbers(void) {
    assert_parsed("0", 3, 0, true);
    assert_parsed("-0.0", 3, 0, true);
    assert_parsed("640", 0, 640, true);
    assert_parsed("+640", 0, 640, true);
    assert_parsed("0640.000", 0, 640, true);
    assert_parsed("500.", 3, 500000, true);
    assert_parsed(".5", 3, 500, true);
    assert_parsed("5.0000000000000000e+02", 3, 500000, true); /* as OpenCV's FileStorage writes it */
    assert_parsed("721.5377", 6, 721537700, true);
    assert_parsed("-16", 3, -16000, true);
    assert_parsed("12345E-3", 3, 12345, true);
    assert_parsed("0e999999999999", 6, 0, true);
}

static void test_rounding_is_half_away_from_zero(void) {
    assert_parsed("0.0005", 3, 1, false);
    assert_parsed("-0.0005", 3, -1, false);
    assert_parsed("0.00049999999999999999999", 3, 0, false);
    assert_parsed("1.9995", 3, 2000, false);
    assert_parsed("2.5", 0, 3, false);
    assert_parsed("0.5e-3", 3, 1, false);
    assert_parsed("1e-999999999999", 6, 0, false);
}

static void test_many_digits(void) {
    assert_parsed("0.3000000000000000000000000000000000000000", 6, 300000, true);
    assert_parsed("0.3000000000000000000000000000000000000001", 6, 300000, false);
    assert_parsed("000000000000000000000000000000000000000001", 0, 1, true);
    assert_parsed("12345678901234567e0", 0, INT64_C(12345678901234567), true);
    assert_parsed("100000000000000000000e-20", 0, 1, true);
}

static void test_saturation(void) {
    assert_parsed("1e300", 3, DECIMAL_LIMIT, true);
    assert_parsed("-99999999999999999999999999999999", 3, -DECIMAL_LIMIT, false);
    assert_parsed("1e17", 0, DECIMAL_LIMIT, true);
    assert_parsed("1e99999999999999999999", 0, DECIMAL_LIMIT, true);
}

static void test_what_is_no_number(void) {
    static const char *const texts[] = {"",   "+",  "-",   ".",  "-.",  "e5",  "1e",  "1e+", "1.2.3", "1-",  "--1",
                                        "1 ", " 1", "0x1", "1f", "1,5", "inf", "nan", ".e1", "1e5.",  "1e 5"};

    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        decimal_t number = {7, false};

        TEST_ASSERT_FALSE_MESSAGE(decimal_parse(texts[i], 3, &number), texts[i]);
        TEST_ASSERT_EQUAL_INT64_MESSAGE(7, number.scaled, texts[i]);
    }
}

static void assert_printed(const char *expected, int64_t scaled, int places) {
    char text[DECIMAL_TEXT_BYTES];

    decimal_print(text, scaled, places);
    TEST_ASSERT_EQUAL_STRING(expected, text);
}

static void test_printing(void) {
    assert_printed("0.000000", 0, 6);
    assert_printed("0.000001", 1, 6);
    assert_printed("-0.000001", -1, 6);
    assert_printed("-12.345678", -12345678, 6);
    assert_printed("1.500000", 1500000, 6);
    assert_printed("42", 42, 0);
    assert_printed("-9223372036854775808", INT64_MIN, 0);
    assert_printed("-9223372036.854775808", INT64_MIN, 9);
}

static void test_printing_without_trailing_zeros(void) {
    static const struct {
        int64_t scaled;
        int places;
        const char *text;
    } cases[] = {{500, 3, "0.5"},    {100000, 3, "100"}, {0, 3, "0"},
                 {-16000, 3, "-16"}, {1, 6, "0.000001"}, {100, 0, "100"}};
    char text[DECIMAL_TEXT_BYTES];

    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        decimal_print_short(text, cases[i].scaled, cases[i].places);
        TEST_ASSERT_EQUAL_STRING(cases[i].text, text);
    }
}

/* One CSV line; the answer lives until the next call. */
static const char *csv_line(const roadpose_pose_t *pose) {
    static char line[512];
    FILE *file = tmpfile();
    const char *got;

    TEST_ASSERT_NOT_NULL(file);
    csv_print_pose(file, 12, pose);
    rewind(file);
    got = fgets(line, sizeof line, file);
    TEST_ASSERT_NOT_NULL(got);
    TEST_ASSERT_EQUAL_INT(EOF, fgetc(file));
    (void)fclose(file);
    return line;
}

static roadpose_pose_t full_pose(void) {
    roadpose_pose_t pose;

    memset(&pose, 0, sizeof pose);
    pose.observed = ROADPOSE_OBSERVED_PITCH | ROADPOSE_OBSERVED_ROLL | ROADPOSE_OBSERVED_HEIGHT;
    pose.pitch_urad = 87266;
    pose.roll_urad = -349066;
    pose.height_um = 1500123;
    pose.paper_pitch_urad = 1;
    pose.paper_roll_urad = -1;
    pose.road_points = 5678;
    pose.support_permille = 912;
    pose.residual_millipx = 204;
    pose.range_near_mm = 3050;
    pose.range_far_mm = 24990;
    return pose;
}

static void test_a_line_with_a_pose(void) {
    const roadpose_pose_t pose = full_pose();

    TEST_ASSERT_EQUAL_STRING("12,ok,4.999973,-20.000009,1.500123,,0.000057,-0.000057,5678,912,0.204,3.050,24.990,,,,,,,,,\n",
                             csv_line(&pose));
}

static void test_an_axis_that_was_not_observed_is_empty(void) {
    roadpose_pose_t pose = full_pose();

    pose.observed = ROADPOSE_OBSERVED_PITCH | ROADPOSE_OBSERVED_HEIGHT;
    TEST_ASSERT_EQUAL_STRING("12,ok,4.999973,,1.500123,,0.000057,,5678,912,0.204,3.050,24.990,,,,,,,,,\n", csv_line(&pose));
    pose.observed = ROADPOSE_OBSERVED_ROLL;
    TEST_ASSERT_EQUAL_STRING("12,ok,,-20.000009,,,,-0.000057,5678,912,0.204,3.050,24.990,,,,,,,,,\n", csv_line(&pose));
}

static void test_without_a_pose_all_numbers_are_empty(void) {
    static const char *const words[] = {"no_disparity", "no_road",  "little_support",
                                        "short_range",  "poor_fit", "outside_limits"};
    roadpose_pose_t pose = full_pose();
    char line[64];

    for (uint8_t status = 1; status < ROADPOSE_STATUS_COUNT; status++) {
        pose.status = status;
        (void)snprintf(line, sizeof line, "12,%s,,,,,,,,,,,,,,,,,,,,\n", words[status - 1]);
        TEST_ASSERT_EQUAL_STRING(line, csv_line(&pose));
    }
}

/* Printed to a millionth of a degree: the printed number is the nearest one, so half a millionth off at most. */
static void test_degrees_over_the_whole_range(void) {
    roadpose_pose_t pose = full_pose();
    double pitch, roll;
    int64_t urad;

    for (urad = -INT64_C(2147483648); urad <= 2147483647; urad += 10000019) {
        pose.pitch_urad = (int32_t)urad;
        pose.roll_urad = (int32_t)(urad / 1000);
        TEST_ASSERT_EQUAL_INT(2, sscanf(csv_line(&pose), "12,ok,%lf,%lf,", &pitch, &roll));
        TEST_ASSERT_TRUE(fabs(pitch - (double)pose.pitch_urad * 1e-6 * DEGREES) <= 0.5000001e-6);
        TEST_ASSERT_TRUE(fabs(roll - (double)pose.roll_urad * 1e-6 * DEGREES) <= 0.5000001e-6);
    }
}

static void test_the_header_has_a_name_for_every_column(void) {
    const roadpose_pose_t pose = full_pose();
    const char *line = csv_line(&pose);
    char header[512];
    FILE *file = tmpfile();
    int commas = 0;

    TEST_ASSERT_NOT_NULL(file);
    csv_print_header(file);
    rewind(file);
    TEST_ASSERT_NOT_NULL(fgets(header, sizeof header, file));
    (void)fclose(file);
    TEST_ASSERT_EQUAL_INT(0, strncmp(header, "frame,status,pitch_deg,roll_deg,height_m,yaw_deg,", 49));
    for (const char *c = header; *c != '\0'; c++)
        commas += *c == ',' ? 1 : 0;
    for (; *line != '\0'; line++)
        commas -= *line == ',' ? 1 : 0;
    TEST_ASSERT_EQUAL_INT(0, commas);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_exact_numbers);
    RUN_TEST(test_rounding_is_half_away_from_zero);
    RUN_TEST(test_many_digits);
    RUN_TEST(test_saturation);
    RUN_TEST(test_what_is_no_number);
    RUN_TEST(test_printing);
    RUN_TEST(test_printing_without_trailing_zeros);
    RUN_TEST(test_a_line_with_a_pose);
    RUN_TEST(test_an_axis_that_was_not_observed_is_empty);
    RUN_TEST(test_without_a_pose_all_numbers_are_empty);
    RUN_TEST(test_degrees_over_the_whole_range);
    RUN_TEST(test_the_header_has_a_name_for_every_column);
    return UNITY_END();
}
