/* One road written in the layout of every source: each must be read as what it is, with its invalid marks. */
#include <math.h>
#include <string.h>

#include "pose_checks.h"
#include "random_numbers.h"
#include "roadpose/roadpose.h"
#include "synthetic.h"
#include "unity.h"

enum { WIDTH = 640, HEIGHT = 480, PIXELS = WIDTH * HEIGHT };

static const true_pose_t truth = {3, -4, 1.4};
static roadpose_t instance;
static roadpose_rig_t rig;
static double disparity[PIXELS]; /* 0: no match */
static uint8_t samples[2 * PIXELS], confidence[2 * PIXELS];

static double tidy_disparity(int u, int v) {
    const double d = true_disparity_at(&rig, true_plane_of(&rig, truth), u, v);
    return d > 0.1 && d < 127 ? d : 0;
}

void setUp(void) {
    random_numbers_t numbers = random_numbers("formats");
    rig = rig_640x480();
    memset(confidence, 0, sizeof confidence);
    for (int i = 0; i < PIXELS; i++)
        disparity[i] = random_between(&numbers, 0, 4) ? tidy_disparity(i % WIDTH, i / WIDTH) : 0;
}

void tearDown(void) {}

static void put_native(uint8_t *bytes, int index, unsigned value) {
    const uint16_t word = (uint16_t)value;
    memcpy(bytes + 2 * index, &word, 2);
}

static unsigned scaled(double d, int bits) { return (unsigned)floor(ldexp(d, bits) + 0.5); }

/* The writers follow the sources' own descriptions, not the library's descriptor. */
static void write_u16_q8(int i, double d) { put_native(samples, i, d > 0 ? scaled(d, 8) : 0); }

static void write_opencv(int i, double d) { put_native(samples, i, d > 0 ? scaled(d, 4) : (unsigned)-16); }

/* Q10.5 with garbage where the confidence is at or under half of its range. */
static void write_vpi(int i, double d) {
    put_native(samples, i, d > 0 ? scaled(d, 5) : 32u * 40);
    put_native(confidence, i, d > 0 ? 40000u + (unsigned)i % 25000 : (unsigned)i % 32767);
}

/* [15] sign, [14:7] integer, [6:3] fraction, [2:0] confidence 0...7 */
static void write_ti_sde(int i, double d) {
    const unsigned marks[] = {0x8000u | 40u << 7 | 7u, 40u << 7, 0xFFFFu, 0u};
    put_native(samples, i, d > 0 ? scaled(d, 4) << 3 | (1u + (unsigned)i % 7) : marks[i % 4]);
}

static void write_libsgm(int i, double d) { put_native(samples, i, d > 0 ? scaled(d, 4) : 0xFFFFu); }

static void write_triclops(int i, double d) {
    const unsigned word = d > 0 ? scaled(d, 8) : 0xFF00u + (unsigned)i % 256;
    samples[2 * i] = (uint8_t)(word >> 8);
    samples[2 * i + 1] = (uint8_t)(word & 255);
}

static uint32_t expected_valid(int bits) {
    uint32_t valid = 0;
    for (int v = 0; v < HEIGHT; v += ROADPOSE_ROW_STEP)
        for (int u = 0; u < WIDTH; u += ROADPOSE_COLUMN_STEP) valid += scaled(disparity[v * WIDTH + u], bits) > 0;
    return valid;
}

static roadpose_pose_t run(const roadpose_disparity_format_t *format) {
    roadpose_frame_t frame = frame_of(&rig, samples);
    roadpose_pose_t pose;
    if (format->has_confidence_image) frame.confidence = confidence;
    frame.confidence_stride_bytes = 2 * WIDTH;
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_init(&instance, &rig, format, NULL));
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_process(&instance, &frame, &pose));
    return pose;
}

/* Rounding to 1/2^bits px: 1/16 px is 0.018 px (1 sigma). Over a few thousand points, with a lever of about 3, some
 * 0.001 px stay; h / (B f) = 0.0093 rad/px: 10 urad. 5 times that, and 0.1 % of the height. */
static void check_pose(const roadpose_pose_t *pose) {
    TEST_ASSERT_EQUAL(ROADPOSE_STATUS_OK, pose->status);
    TEST_ASSERT_INT_WITHIN(50 + 10, 52360, pose->pitch_urad);
    TEST_ASSERT_INT_WITHIN(50 + 10, -69813, pose->roll_urad);
    TEST_ASSERT_INT_WITHIN(1400, 1400000, pose->height_um);
}

static void check(roadpose_format_preset_t preset, void (*write)(int, double), int bits) {
    roadpose_disparity_format_t format;
    TEST_ASSERT_TRUE(roadpose_format_preset(&format, preset));
    for (int i = 0; i < PIXELS; i++) write(i, disparity[i]);
    const roadpose_pose_t pose = run(&format);
    TEST_ASSERT_EQUAL(expected_valid(bits), pose.valid_samples);
    check_pose(&pose);
}

static void test_u16_q8(void) { check(ROADPOSE_FORMAT_U16_Q8, write_u16_q8, 8); }
static void test_opencv(void) { check(ROADPOSE_FORMAT_OPENCV, write_opencv, 4); }
static void test_vpi(void) { check(ROADPOSE_FORMAT_VPI, write_vpi, 5); }
static void test_ti_sde(void) { check(ROADPOSE_FORMAT_TI_SDE, write_ti_sde, 4); }
static void test_libsgm(void) { check(ROADPOSE_FORMAT_LIBSGM, write_libsgm, 4); }
static void test_triclops(void) { check(ROADPOSE_FORMAT_TRICLOPS, write_triclops, 8); }

/* Both byte orders and a stride with a gap give the same bits as the plain buffer. */
static void test_byte_order_and_stride(void) {
    static uint8_t other[2 * (WIDTH + 7) * HEIGHT + 1];
    roadpose_disparity_format_t format = format_u16_q8();
    for (int i = 0; i < PIXELS; i++) write_u16_q8(i, disparity[i]);
    const roadpose_pose_t plain = run(&format);
    for (int order = ROADPOSE_BYTES_LITTLE; order <= ROADPOSE_BYTES_BIG; order++) {
        roadpose_frame_t frame = frame_of(&rig, other + 1); /* odd address */
        roadpose_pose_t pose;
        frame.stride_bytes = 2 * (WIDTH + 7) - 1;
        memset(other, 0x77, sizeof other);
        for (int i = 0; i < PIXELS; i++) {
            uint8_t *at = other + 1 + (size_t)(i / WIDTH) * frame.stride_bytes + 2 * (size_t)(i % WIDTH);
            const unsigned word = disparity[i] > 0 ? scaled(disparity[i], 8) : 0;
            at[order == ROADPOSE_BYTES_BIG ? 0 : 1] = (uint8_t)(word >> 8);
            at[order == ROADPOSE_BYTES_BIG ? 1 : 0] = (uint8_t)(word & 255);
        }
        format.byte_order = (uint8_t)order;
        TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_init(&instance, &rig, &format, NULL));
        TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_process(&instance, &frame, &pose));
        TEST_ASSERT_TRUE(same_pose(&plain, &pose));
    }
}

/* A matcher that reads 0.25 px too much, put right by the offset; and the sign of the offset. */
static void test_offset(void) {
    roadpose_disparity_format_t format = format_u16_q8();
    for (int i = 0; i < PIXELS; i++) write_u16_q8(i, disparity[i] > 0 ? disparity[i] + 0.25 : 0);
    format.offset_millipx = -250;
    const roadpose_pose_t pose = run(&format);
    check_pose(&pose);
    for (int i = 0; i < PIXELS; i++) write_u16_q8(i, disparity[i] > 4 ? disparity[i] - 3 : 0);
    format.offset_millipx = 3000;
    const roadpose_pose_t shifted = run(&format);
    check_pose(&shifted);
}

/* What offset does near the ends: 0 and negative are no match, as is the limit. */
static void test_offset_at_the_ends(void) {
    roadpose_disparity_format_t format = format_u16_q8();
    format.has_invalid = false;
    format.offset_millipx = -1000;
    for (int i = 0; i < PIXELS; i++) put_native(samples, i, 256);
    TEST_ASSERT_EQUAL(0, run(&format).valid_samples);
    for (int i = 0; i < PIXELS; i++) put_native(samples, i, 257);
    TEST_ASSERT_EQUAL(HEIGHT / ROADPOSE_ROW_STEP * (WIDTH / ROADPOSE_COLUMN_STEP), run(&format).valid_samples);
    format.offset_millipx = 1000;
    for (int i = 0; i < PIXELS; i++) put_native(samples, i, (ROADPOSE_MAX_DISPARITY - 1) * 256u);
    TEST_ASSERT_EQUAL(0, run(&format).valid_samples);
    for (int i = 0; i < PIXELS; i++) put_native(samples, i, (ROADPOSE_MAX_DISPARITY - 1) * 256u - 1);
    TEST_ASSERT_EQUAL(HEIGHT / ROADPOSE_ROW_STEP * (WIDTH / ROADPOSE_COLUMN_STEP), run(&format).valid_samples);
}

static void test_unknown_presets_are_refused(void) {
    roadpose_disparity_format_t format, copy;
    memset(&format, 0x42, sizeof format);
    memcpy(&copy, &format, sizeof copy);
    TEST_ASSERT_FALSE(roadpose_format_preset(&format, (roadpose_format_preset_t)6));
    TEST_ASSERT_FALSE(roadpose_format_preset(&format, (roadpose_format_preset_t)1000));
    TEST_ASSERT_EQUAL(0, memcmp(&copy, &format, sizeof copy));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_u16_q8);
    RUN_TEST(test_opencv);
    RUN_TEST(test_vpi);
    RUN_TEST(test_ti_sde);
    RUN_TEST(test_libsgm);
    RUN_TEST(test_triclops);
    RUN_TEST(test_byte_order_and_stride);
    RUN_TEST(test_offset);
    RUN_TEST(test_offset_at_the_ends);
    RUN_TEST(test_unknown_presets_are_refused);
    return UNITY_END();
}
