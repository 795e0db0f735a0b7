#include "fixed_point/fixed_point.h"

#include "lsb.h"
#include "random_numbers.h"

enum { DRAWS = 200000 };

static random_numbers_t numbers;
static const int64_t corners[] = {0,         1,         -1,        2,          -2,         3,          -3,
                                  255,       256,       -256,      INT32_MAX,  INT32_MIN,  UINT32_MAX, -4294967295LL,
                                  1LL << 40, -(1LL << 40), (1LL << 61) - 1, -(1LL << 61), (1LL << 62) - 1, 1LL - (1LL << 62)};
#define CORNERS ((int)(sizeof corners / sizeof corners[0]))

void setUp(void) { numbers = random_numbers("fixed point"); }
void tearDown(void) {}

static int64_t any_signed(unsigned bits) {
    const int64_t size = (int64_t)random_any_magnitude(&numbers, bits);
    return random_bits(&numbers) & 1 ? -size : size;
}

/* Exact: floor(x / 2^bits) by division, which C rounds towards zero. */
static int64_t floor_divided(int64_t x, unsigned bits) {
    if (bits == 63) return x < 0 ? -1 : 0;
    const int64_t divisor = (int64_t)1 << bits;
    return x / divisor - (x % divisor < 0);
}

static void test_floor_shift(void) {
    for (unsigned bits = 0; bits <= 63; bits++) {
        for (int i = 0; i < CORNERS; i++)
            TEST_ASSERT_TRUE(roadpose_floor_shift(corners[i], bits) == floor_divided(corners[i], bits));
        for (int i = 0; i < DRAWS / 64; i++) {
            const int64_t x = (int64_t)random_bits(&numbers);
            TEST_ASSERT_TRUE(roadpose_floor_shift(x, bits) == floor_divided(x, bits));
        }
        TEST_ASSERT_TRUE(roadpose_floor_shift(INT64_MIN, bits) == floor_divided(INT64_MIN, bits));
        TEST_ASSERT_TRUE(roadpose_floor_shift(INT64_MAX, bits) == floor_divided(INT64_MAX, bits));
    }
    for (unsigned bits = 0; bits <= 31; bits++)
        for (int i = 0; i < DRAWS / 32; i++) {
            const int32_t x = (int32_t)(uint32_t)random_bits(&numbers);
            TEST_ASSERT_EQUAL_INT32((int32_t)floor_divided(x, bits), roadpose_floor_shift32(x, bits));
        }
    TEST_ASSERT_EQUAL_INT32(-1, roadpose_floor_shift32(INT32_MIN, 31));
}

static void test_clamp_and_abs(void) {
    TEST_ASSERT_TRUE(roadpose_clamp(5, -3, 7) == 5 && roadpose_clamp(-4, -3, 7) == -3 && roadpose_clamp(8, -3, 7) == 7);
    TEST_ASSERT_EQUAL_INT32(INT32_MAX, roadpose_clamp32(INT64_MAX));
    TEST_ASSERT_EQUAL_INT32(INT32_MIN, roadpose_clamp32(INT64_MIN));
    TEST_ASSERT_EQUAL_INT32(INT32_MAX, roadpose_clamp32(INT32_MAX));
    TEST_ASSERT_EQUAL_INT32(-7, roadpose_clamp32(-7));
    TEST_ASSERT_TRUE(roadpose_abs(-INT64_MAX) == INT64_MAX && roadpose_abs(0) == 0 && roadpose_abs(9) == 9);
}

/* The definition itself: root^2 <= x < (root + 1)^2. */
static void check_sqrt(uint64_t x) {
    const uint64_t root = roadpose_sqrt(x);
    TEST_ASSERT_TRUE(root * root <= x);
    TEST_ASSERT_TRUE(root == UINT32_MAX || (root + 1) * (root + 1) > x);
}

static void test_sqrt(void) {
    for (uint64_t x = 0; x < 70000; x++) check_sqrt(x);
    for (int i = 0; i < DRAWS; i++) check_sqrt(random_any_magnitude(&numbers, 64));
    for (int i = 0; i < DRAWS; i++) {
        const uint64_t root = random_any_magnitude(&numbers, 32);
        check_sqrt(root * root);
        check_sqrt(root * root - 1);
        check_sqrt(root * root + 1);
    }
    check_sqrt(UINT64_MAX);
}

/* numerator * 2^bits / denominator towards zero in 128 bits, saturated: exact, so the tolerance is nothing. */
__extension__ typedef __int128 wide_t;

static int64_t exact_ratio(int64_t numerator, int64_t denominator, unsigned bits) {
    const wide_t limit = ROADPOSE_RATIO_MAX;
    if (numerator == 0) return 0;
    if (denominator == 0) return numerator < 0 ? -ROADPOSE_RATIO_MAX : ROADPOSE_RATIO_MAX;
    const wide_t quotient = (wide_t)numerator * ((wide_t)1 << bits) / denominator;
    return (int64_t)(quotient > limit ? limit : quotient < -limit ? -limit : quotient);
}

static void check_ratio(int64_t numerator, int64_t denominator, unsigned bits) {
    const int64_t result = roadpose_ratio(numerator, denominator, bits);
    char text[160];
    if (result == exact_ratio(numerator, denominator, bits)) return;
    snprintf(text, sizeof text, "%lld / %lld * 2^%u gives %lld", (long long)numerator, (long long)denominator, bits,
             (long long)result);
    TEST_FAIL_MESSAGE(text);
}

static void test_ratio(void) {
    for (unsigned bits = 0; bits <= 40; bits++) {
        for (int i = 0; i < CORNERS; i++)
            for (int j = 0; j < CORNERS; j++) check_ratio(corners[i], corners[j], bits);
        for (int i = 0; i < DRAWS / 40; i++) check_ratio(any_signed(63), any_signed(62), bits);
        check_ratio(INT64_MIN, 1, bits);
        check_ratio(INT64_MAX, -1, bits);
        check_ratio(INT64_MIN, -1, bits);
    }
}

static void test_excess_bits(void) {
    for (unsigned bits = 1; bits <= 62; bits++)
        for (int i = 0; i < DRAWS / 62; i++) {
            const int64_t x = (int64_t)random_any_magnitude(&numbers, 63);
            const unsigned shift = roadpose_excess_bits(x, bits);
            TEST_ASSERT_TRUE((x >> shift) < ((int64_t)1 << bits));
            TEST_ASSERT_TRUE(shift == 0 || (x >> (shift - 1)) >= ((int64_t)1 << bits)); /* no more than needed */
        }
}

/* 1 LSB: 0.5 for the last rounding, 0.015 for the table's, and the rest for 30 turns whose points are cut to whole
 * numbers: 30 / 2^24 rad = 1.8 urad at worst, a tenth of that in the mean, as the cuts go both ways. */
static void check_arctangent(int32_t y, int32_t x, double tolerance) {
    ASSERT_LSB(tolerance, 1e6 * atan2(y, x), roadpose_arctangent(y, x), "arctangent");
}

static int32_t component(unsigned bits) { return (int32_t)any_signed(bits); }

static void test_arctangent_of_long_vectors(void) {
    const int32_t big = 1 << 30;
    for (int i = 0; i < DRAWS; i++) {
        const int32_t long_side = (int32_t)random_between(&numbers, 1 << 24, big) * (random_bits(&numbers) & 1 ? 1 : -1);
        const int32_t other = component(30);
        if (random_bits(&numbers) & 1) check_arctangent(other, long_side, 1);
        else check_arctangent(long_side, other, 1);
    }
    /* Turns round the circle in steps of 1 mrad: every quadrant and its borders. */
    for (int i = -3141; i <= 3141; i++) check_arctangent((int32_t)(big * sin(i / 1e3)), (int32_t)(big * cos(i / 1e3)), 1);
}

static void test_arctangent_on_the_axes(void) {
    const int32_t big = 1 << 30;
    TEST_ASSERT_EQUAL_INT32(0, roadpose_arctangent(0, 0));
    TEST_ASSERT_INT_WITHIN(1, 0, roadpose_arctangent(0, big));
    TEST_ASSERT_INT_WITHIN(1, 1570796, roadpose_arctangent(big, 0));
    TEST_ASSERT_INT_WITHIN(1, -1570796, roadpose_arctangent(-big, 0));
    TEST_ASSERT_INT_WITHIN(1, 3141593, roadpose_arctangent(0, -big));
    TEST_ASSERT_INT_WITHIN(1, 785398, roadpose_arctangent(big, big));
    TEST_ASSERT_INT_WITHIN(1, -2356194, roadpose_arctangent(-big, -big));
}

/* Short vectors lose what their length says: 30 cuts of up to one unit each on a vector of that length. */
static void test_arctangent_of_short_vectors(void) {
    for (int i = 0; i < DRAWS; i++) {
        const int32_t y = component(24), x = component(24);
        const double length = hypot(y, x);
        if (length >= 64) check_arctangent(y, x, 1 + 30e6 / length);
    }
}

/* The first numbers from seed 0, as Numerical Recipes (2nd edition, chapter 7.1) prints them to check an
 * implementation. */
static void test_generator(void) {
    static const uint32_t published[] = {0x3C6EF35F, 0x47502932, 0xD1CCF6E9, 0xAAF95334, 0x6252E503, 0x9F2EC686};
    uint32_t state = 0;
    for (int i = 0; i < 6; i++) {
        state = roadpose_lcg_next(state);
        TEST_ASSERT_EQUAL_HEX32(published[i], state);
    }
}

/* Each of 10 numbers comes 20 000 times of 200 000, give or take 5 standard deviations of 134. */
static void test_generator_below(void) {
    int counts[10] = {0};
    uint32_t state = (uint32_t)random_bits(&numbers);
    for (int i = 0; i < 200000; i++) {
        const uint32_t drawn = roadpose_lcg_below(&state, 10);
        TEST_ASSERT_TRUE(drawn < 10);
        counts[drawn]++;
    }
    for (int i = 0; i < 10; i++) TEST_ASSERT_INT_WITHIN(670, 20000, counts[i]);
    TEST_ASSERT_EQUAL_UINT32(0, roadpose_lcg_below(&state, 1));
    for (int i = 0; i < 1000; i++) TEST_ASSERT_TRUE(roadpose_lcg_below(&state, UINT32_MAX) < UINT32_MAX);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_floor_shift);
    RUN_TEST(test_clamp_and_abs);
    RUN_TEST(test_sqrt);
    RUN_TEST(test_ratio);
    RUN_TEST(test_excess_bits);
    RUN_TEST(test_arctangent_of_long_vectors);
    RUN_TEST(test_arctangent_on_the_axes);
    RUN_TEST(test_arctangent_of_short_vectors);
    RUN_TEST(test_generator);
    RUN_TEST(test_generator_below);
    return UNITY_END();
}
