/* The tracker: known shifts, bad input, and nothing read outside the images (this runs under sanitizers too). */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "guarded_buffer.h"
#include "random_numbers.h"
#include "roadpose/tracker.h"
#include "unity.h"

#define WIDTH 320
#define HEIGHT 200

static random_numbers_t numbers;
static roadpose_tracker_t tracker;
static uint8_t previous_pixels[WIDTH * HEIGHT], present_pixels[WIDTH * HEIGHT];
static roadpose_track_t tracks[ROADPOSE_TRACKER_CELLS];

void setUp(void) { TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_tracker_init(&tracker, NULL)); }
void tearDown(void) {}

static roadpose_grey_t image_of(const uint8_t *pixels) { return (roadpose_grey_t){pixels, WIDTH, WIDTH, HEIGHT}; }

static double lattice(int x, int y, unsigned seed) {
    uint32_t h = (uint32_t)x * 0x9E3779B1u + (uint32_t)y * 0x85EBCA77u + seed;
    h = (h ^ (h >> 15)) * 0xC2B2AE3Du;
    h = (h ^ (h >> 13)) * 0x27D4EB2Fu;
    return (h ^ (h >> 16)) / 4294967296.0;
}

/* Value noise: random numbers on a lattice with a smooth way between them. */
static double noise_at(double u, double v, unsigned seed) {
    const int x = (int)floor(u), y = (int)floor(v);
    const double s = u - x, t = v - y, a = s * s * (3 - 2 * s), b = t * t * (3 - 2 * t);
    const double top = lattice(x, y, seed) * (1 - a) + lattice(x + 1, y, seed) * a;
    const double bottom = lattice(x, y + 1, seed) * (1 - a) + lattice(x + 1, y + 1, seed) * a;
    return top * (1 - b) + bottom * b;
}

static double texture(double u, double v) {
    return 40 + 80 * noise_at(u / 6, v / 6, 1) + 80 * noise_at(u / 23, v / 23, 2);
}

static void draw(double shift_u, double shift_v, double gain, double offset, double noise) {
    for (int v = 0; v < HEIGHT; v++)
        for (int u = 0; u < WIDTH; u++) {
            previous_pixels[v * WIDTH + u] = (uint8_t)lround(texture(u, v));
            const double grey = gain * texture(u - shift_u, v - shift_v) + offset + noise * random_normal(&numbers);
            present_pixels[v * WIDTH + u] = (uint8_t)lround(fmin(fmax(grey, 0), 255));
        }
}

static size_t track(void) {
    const roadpose_grey_t previous = image_of(previous_pixels), present = image_of(present_pixels);
    size_t count = 12345;
    TEST_ASSERT_EQUAL(ROADPOSE_OK,
                      roadpose_tracker_track(&tracker, &previous, &present, tracks, ROADPOSE_TRACKER_CELLS, &count));
    TEST_ASSERT_LESS_OR_EQUAL(ROADPOSE_TRACKER_CELLS, count);
    return count;
}

/* Rounding to whole grey levels alone costs 0.02 px; 99 of 100 tracks must be right to a twentieth of a pixel. */
static void check_shift(double shift_u, double shift_v, size_t least, double tolerance) {
    const size_t count = track();
    size_t good = 0;
    for (size_t i = 0; i < count; i++) {
        const double eu = (tracks[i].u1_q8 - tracks[i].u0_q8) / 256.0 - shift_u;
        const double ev = (tracks[i].v1_q8 - tracks[i].v0_q8) / 256.0 - shift_v;
        good += fabs(eu) <= tolerance && fabs(ev) <= tolerance;
    }
    TEST_ASSERT_GREATER_OR_EQUAL(least, count);
    TEST_ASSERT_GREATER_OR_EQUAL(count * 95, good * 100);
}

static void test_known_shifts(void) {
    static const double shifts[][2] = {{0, 0}, {0.5, -0.25}, {3.3, 1.7}, {-7.6, 4.4}, {15.2, -11.8}, {-28.5, 20.1}};
    for (int i = 0; i < 6; i++) {
        draw(shifts[i][0], shifts[i][1], 1, 0, 0);
        check_shift(shifts[i][0], shifts[i][1], 100, 0.06);
    }
}

static void test_other_exposure_and_noise(void) {
    draw(4.4, -2.3, 1, 15, 0);
    check_shift(4.4, -2.3, 150, 0.06);
    draw(4.4, -2.3, 1.05, -6, 2);
    check_shift(4.4, -2.3, 120, 0.25);
}

static void test_nothing_to_track(void) {
    memset(previous_pixels, 90, sizeof previous_pixels);
    memset(present_pixels, 90, sizeof present_pixels);
    TEST_ASSERT_EQUAL(0, track());
    for (int i = 0; i < WIDTH * HEIGHT; i++) previous_pixels[i] = (uint8_t)(i % WIDTH / 8 % 2 * 200); /* edges, no corners */
    memcpy(present_pixels, previous_pixels, sizeof present_pixels);
    TEST_ASSERT_EQUAL(0, track());
}

/* Images that have nothing in common: hardly anything passes for a match. */
static void test_unlike_images(void) {
    random_bytes(&numbers, previous_pixels, sizeof previous_pixels);
    random_bytes(&numbers, present_pixels, sizeof present_pixels);
    TEST_ASSERT_LESS_OR_EQUAL(2, track());
}

static void test_capacity(void) {
    const roadpose_grey_t previous = image_of(previous_pixels), present = image_of(present_pixels);
    size_t count;
    draw(2, 1, 1, 0, 0);
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_tracker_track(&tracker, &previous, &present, tracks, 7, &count));
    TEST_ASSERT_EQUAL(7, count);
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_tracker_track(&tracker, &previous, &present, NULL, 0, &count));
    TEST_ASSERT_EQUAL(0, count);
}

/* Any size, any stride, any content, in buffers that end where the image ends. */
static void test_any_image(void) {
    for (int round = 0; round < 60; round++) {
        const int width = (int)random_between(&numbers, 64, 200), height = (int)random_between(&numbers, 64, 140);
        const int stride = width + (int)random_between(&numbers, 0, 9);
        const size_t bytes = (size_t)stride * (size_t)(height - 1) + (size_t)width;
        guarded_buffer_t one = guarded_buffer(bytes, (size_t)round % 4), two = guarded_buffer(bytes, 1);
        random_bytes(&numbers, one.bytes, bytes);
        if (round % 3) memcpy(two.bytes, one.bytes, bytes);
        else random_bytes(&numbers, two.bytes, bytes);
        if (round % 3 == 2) memmove(two.bytes + 5, two.bytes, bytes - 5);
        const roadpose_grey_t a = {one.bytes, (uint32_t)stride, (uint16_t)width, (uint16_t)height};
        const roadpose_grey_t b = {two.bytes, (uint32_t)stride, (uint16_t)width, (uint16_t)height};
        size_t count;
        TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_tracker_track(&tracker, &a, &b, tracks, ROADPOSE_TRACKER_CELLS, &count));
        for (size_t i = 0; i < count; i++)
            TEST_ASSERT_TRUE(tracks[i].u1_q8 >= 0 && tracks[i].u1_q8 <= (width - 1) * 256 && tracks[i].v1_q8 >= 0 &&
                             tracks[i].v1_q8 <= (height - 1) * 256);
        TEST_ASSERT_TRUE(guards_are_whole(&one) && guards_are_whole(&two));
        free_guarded_buffer(&one);
        free_guarded_buffer(&two);
    }
}

static roadpose_result_t try_images(roadpose_grey_t a, roadpose_grey_t b) {
    size_t count = 99;
    const roadpose_result_t result = roadpose_tracker_track(&tracker, &a, &b, tracks, 3, &count);
    TEST_ASSERT_TRUE(result == ROADPOSE_OK || count == 99);
    return result;
}

static void test_wrong_calls(void) {
    static roadpose_tracker_t raw;
    const roadpose_grey_t good = image_of(previous_pixels);
    roadpose_grey_t bad = good;
    size_t count;
    TEST_ASSERT_EQUAL(ROADPOSE_ERROR_NULL, roadpose_tracker_init(NULL, NULL));
    TEST_ASSERT_EQUAL(ROADPOSE_ERROR_NULL, roadpose_tracker_track(NULL, &good, &good, tracks, 3, &count));
    TEST_ASSERT_EQUAL(ROADPOSE_ERROR_NULL, roadpose_tracker_track(&tracker, NULL, &good, tracks, 3, &count));
    TEST_ASSERT_EQUAL(ROADPOSE_ERROR_NULL, roadpose_tracker_track(&tracker, &good, NULL, tracks, 3, &count));
    TEST_ASSERT_EQUAL(ROADPOSE_ERROR_NULL, roadpose_tracker_track(&tracker, &good, &good, NULL, 3, &count));
    TEST_ASSERT_EQUAL(ROADPOSE_ERROR_NULL, roadpose_tracker_track(&tracker, &good, &good, tracks, 3, NULL));
    TEST_ASSERT_EQUAL(ROADPOSE_ERROR_ORDER, roadpose_tracker_track(&raw, &good, &good, tracks, 3, &count));
    bad.pixels = NULL;
    TEST_ASSERT_EQUAL(ROADPOSE_ERROR_NULL, try_images(good, bad));
    bad = good;
    bad.width_px = 63;
    TEST_ASSERT_EQUAL(ROADPOSE_ERROR_SIZE, try_images(bad, bad));
    TEST_ASSERT_EQUAL(ROADPOSE_ERROR_SIZE, try_images(good, bad));
    bad.width_px = ROADPOSE_MAX_WIDTH + 1;
    TEST_ASSERT_EQUAL(ROADPOSE_ERROR_SIZE, try_images(bad, bad));
    bad = good;
    bad.stride_bytes = WIDTH - 1;
    TEST_ASSERT_EQUAL(ROADPOSE_ERROR_STRIDE, try_images(good, bad));
}

static void test_settings(void) {
    roadpose_tracker_settings_t settings = {0, 0};
    roadpose_tracker_settings_default(NULL);
    TEST_ASSERT_EQUAL(ROADPOSE_ERROR_SETTINGS, roadpose_tracker_init(&tracker, &settings));
    roadpose_tracker_settings_default(&settings);
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_tracker_init(&tracker, &settings));
    settings.corner_min = 60001;
    TEST_ASSERT_EQUAL(ROADPOSE_ERROR_SETTINGS, roadpose_tracker_init(&tracker, &settings));
    settings.corner_min = 60000;
    settings.mismatch_max_percent = 101;
    TEST_ASSERT_EQUAL(ROADPOSE_ERROR_SETTINGS, roadpose_tracker_init(&tracker, &settings));
}

int main(void) {
    numbers = random_numbers("tracker");
    UNITY_BEGIN();
    RUN_TEST(test_known_shifts);
    RUN_TEST(test_other_exposure_and_noise);
    RUN_TEST(test_nothing_to_track);
    RUN_TEST(test_unlike_images);
    RUN_TEST(test_capacity);
    RUN_TEST(test_any_image);
    RUN_TEST(test_wrong_calls);
    RUN_TEST(test_settings);
    return UNITY_END();
}
