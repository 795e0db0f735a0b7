/* Wrong calls: the result code names the fault, and the instance and all outputs stay as they were. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "roadpose/roadpose.h"
#include "synthetic.h"
#include "unity.h"

static roadpose_t instance, before;
static roadpose_rig_t rig;
static roadpose_disparity_format_t format;
static roadpose_settings_t settings;
static roadpose_frame_t frame;
static roadpose_pose_t pose, pose_before;
static uint16_t samples[640 * 480];

void setUp(void) {
    const true_pose_t truth = {2, 1, 1.5};
    rig = rig_640x480();
    format = format_u16_q8();
    roadpose_settings_default(&settings);
    render_road(&rig, truth, 256, samples);
    frame = frame_of(&rig, samples);
    memset(&instance, 0x5A, sizeof instance);
    memset(&pose, 0x33, sizeof pose);
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_init(&instance, &rig, &format, &settings));
}

void tearDown(void) {}

static void remember(void) {
    memcpy(&before, &instance, sizeof before);
    memcpy(&pose_before, &pose, sizeof pose_before);
}

static void expect(roadpose_result_t wanted, roadpose_result_t result, const char *what) {
    TEST_ASSERT_EQUAL_INT_MESSAGE(wanted, result, what);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, memcmp(&before, &instance, sizeof before), what);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, memcmp(&pose_before, &pose, sizeof pose_before), what);
}

/* Tries init() with one field changed; restores the field. */
#define BAD(object, field, value, wanted)                                              \
    do {                                                                               \
        const long long bad_value = (value);                                           \
        const long long good_value = (long long)(object).field;                        \
        remember();                                                                    \
        set_##object##_##field(bad_value);                                             \
        expect(wanted, roadpose_init(&instance, &rig, &format, &settings), #field " = " #value); \
        set_##object##_##field(good_value);                                            \
    } while (0)
#define GOOD(object, field, value)                                                     \
    do {                                                                               \
        const long long good_value = (long long)(object).field;                        \
        set_##object##_##field(value);                                                 \
        TEST_ASSERT_EQUAL_INT_MESSAGE(ROADPOSE_OK, roadpose_init(&instance, &rig, &format, &settings), \
                                      #field " = " #value);                            \
        set_##object##_##field(good_value);                                            \
    } while (0)
#define SETTER(object, type, field) \
    static void set_##object##_##field(long long value) { (object).field = (type)value; }

SETTER(rig, uint16_t, width_px)
SETTER(rig, uint16_t, height_px)
SETTER(rig, int32_t, focal_millipx)
SETTER(rig, int32_t, cu_millipx)
SETTER(rig, int32_t, cv_millipx)
SETTER(rig, int32_t, baseline_um)
SETTER(format, uint8_t, byte_order)
SETTER(format, uint8_t, value_shift)
SETTER(format, uint8_t, value_bits)
SETTER(format, uint8_t, fraction_bits)
SETTER(format, uint16_t, invalid_last)
SETTER(format, uint8_t, confidence_shift)
SETTER(format, uint8_t, confidence_bits)
SETTER(format, int32_t, offset_millipx)
SETTER(settings, uint8_t, method)
SETTER(settings, uint8_t, points_percent)
SETTER(settings, int32_t, corridor_half_width_mm)
SETTER(settings, int32_t, corridor_range_mm)
SETTER(settings, int32_t, obstacle_height_mm)
SETTER(settings, int32_t, noise_millipx)
SETTER(settings, int32_t, unevenness_mm)
SETTER(settings, int32_t, pitch_min_urad)
SETTER(settings, int32_t, pitch_max_urad)
SETTER(settings, int32_t, roll_max_urad)
SETTER(settings, int32_t, height_min_um)
SETTER(settings, int32_t, height_max_um)
SETTER(settings, uint16_t, points_min)
SETTER(settings, uint16_t, support_min_permille)
SETTER(settings, int32_t, range_min_mm)

/* Both ends of the range are right, one beyond each is not. */
#define RANGE(object, field, low, high, wanted)      \
    do {                                             \
        GOOD(object, field, low);                    \
        GOOD(object, field, high);                   \
        BAD(object, field, (long long)(low)-1, wanted); \
        BAD(object, field, (long long)(high) + 1, wanted); \
    } while (0)

static void test_rig_out_of_range(void) {
    RANGE(rig, focal_millipx, 50000, 4000000, ROADPOSE_ERROR_RIG);
    RANGE(rig, cu_millipx, 0, 639000, ROADPOSE_ERROR_RIG);
    RANGE(rig, cv_millipx, 0, 479000, ROADPOSE_ERROR_RIG);
    RANGE(rig, baseline_um, 20000, 2000000, ROADPOSE_ERROR_RIG);
    BAD(rig, focal_millipx, INT32_MIN, ROADPOSE_ERROR_RIG);
    BAD(rig, baseline_um, INT32_MAX, ROADPOSE_ERROR_RIG);
    BAD(rig, width_px, 0, ROADPOSE_ERROR_RIG);
    BAD(rig, height_px, 0, ROADPOSE_ERROR_RIG);
    BAD(rig, width_px, 63, ROADPOSE_ERROR_RIG);
    BAD(rig, height_px, 63, ROADPOSE_ERROR_RIG);
    BAD(rig, width_px, ROADPOSE_MAX_WIDTH + 1, ROADPOSE_ERROR_SIZE);
    BAD(rig, height_px, ROADPOSE_MAX_HEIGHT + 1, ROADPOSE_ERROR_SIZE);
    BAD(rig, width_px, 65535, ROADPOSE_ERROR_SIZE);
    GOOD(rig, width_px, ROADPOSE_MAX_WIDTH);
    GOOD(rig, height_px, ROADPOSE_MAX_HEIGHT);
}

static void test_format_out_of_range(void) {
    RANGE(format, offset_millipx, -16000, 16000, ROADPOSE_ERROR_FORMAT);
    BAD(format, offset_millipx, INT32_MIN, ROADPOSE_ERROR_FORMAT);
    BAD(format, byte_order, 3, ROADPOSE_ERROR_FORMAT);
    BAD(format, byte_order, 255, ROADPOSE_ERROR_FORMAT);
    BAD(format, value_shift, 1, ROADPOSE_ERROR_FORMAT); /* with 16 bits of value */
    BAD(format, value_shift, 255, ROADPOSE_ERROR_FORMAT);
    BAD(format, value_bits, 0, ROADPOSE_ERROR_FORMAT);
    BAD(format, value_bits, 17, ROADPOSE_ERROR_FORMAT);
    BAD(format, fraction_bits, 16, ROADPOSE_ERROR_FORMAT);
    BAD(format, value_bits, 7, ROADPOSE_ERROR_FORMAT); /* with 8 fraction bits */
    BAD(format, confidence_bits, 16, ROADPOSE_ERROR_FORMAT);
    format.confidence_bits = 3;
    BAD(format, confidence_shift, 14, ROADPOSE_ERROR_FORMAT);
    GOOD(format, confidence_shift, 13);
    format.has_confidence_image = true;
    remember();
    expect(ROADPOSE_ERROR_FORMAT, roadpose_init(&instance, &rig, &format, &settings), "two confidences");
    format = format_u16_q8();
    format.invalid_first = 2;
    BAD(format, invalid_last, 1, ROADPOSE_ERROR_FORMAT);
}

static void test_settings_out_of_range(void) {
    RANGE(settings, method, 1, 2, ROADPOSE_ERROR_SETTINGS);
    RANGE(settings, points_percent, 1, 100, ROADPOSE_ERROR_SETTINGS);
    RANGE(settings, corridor_half_width_mm, 500, 100000, ROADPOSE_ERROR_SETTINGS);
    RANGE(settings, corridor_range_mm, 5000, 500000, ROADPOSE_ERROR_SETTINGS);
    RANGE(settings, obstacle_height_mm, 100, 5000, ROADPOSE_ERROR_SETTINGS);
    RANGE(settings, noise_millipx, 100, 3000, ROADPOSE_ERROR_SETTINGS);
    RANGE(settings, unevenness_mm, 0, 200, ROADPOSE_ERROR_SETTINGS);
    RANGE(settings, roll_max_urad, 0, 610865, ROADPOSE_ERROR_SETTINGS);
    RANGE(settings, height_min_um, 200000, 4000000, ROADPOSE_ERROR_SETTINGS); /* up to height_max_um */
    RANGE(settings, height_max_um, 300000, 5000000, ROADPOSE_ERROR_SETTINGS);
    RANGE(settings, points_min, 16, ROADPOSE_MAX_POINTS, ROADPOSE_ERROR_SETTINGS);
    RANGE(settings, range_min_mm, 0, 50000, ROADPOSE_ERROR_SETTINGS);
    BAD(settings, support_min_permille, 1001, ROADPOSE_ERROR_SETTINGS);
    BAD(settings, pitch_min_urad, -523600, ROADPOSE_ERROR_SETTINGS);
    BAD(settings, pitch_max_urad, 523600, ROADPOSE_ERROR_SETTINGS);
    BAD(settings, pitch_max_urad, -200000, ROADPOSE_ERROR_SETTINGS); /* below pitch_min_urad */
    BAD(settings, corridor_half_width_mm, -1, ROADPOSE_ERROR_SETTINGS);
    BAD(settings, corridor_range_mm, INT32_MIN, ROADPOSE_ERROR_SETTINGS);
    GOOD(settings, corridor_half_width_mm, 0);
    GOOD(settings, corridor_range_mm, 0);
    GOOD(settings, obstacle_height_mm, 0);
    memset(&settings, 0, sizeof settings);
    remember();
    expect(ROADPOSE_ERROR_SETTINGS, roadpose_init(&instance, &rig, &format, &settings), "zeroed settings");
}

static void test_null_pointers(void) {
    remember();
    TEST_ASSERT_EQUAL(ROADPOSE_ERROR_NULL, roadpose_init(NULL, &rig, &format, &settings));
    expect(ROADPOSE_ERROR_NULL, roadpose_init(&instance, NULL, &format, &settings), "rig");
    expect(ROADPOSE_ERROR_NULL, roadpose_init(&instance, &rig, NULL, &settings), "format");
    expect(ROADPOSE_ERROR_NULL, roadpose_frame_begin(NULL, &frame), "begin, instance");
    expect(ROADPOSE_ERROR_NULL, roadpose_frame_begin(&instance, NULL), "begin, frame");
    expect(ROADPOSE_ERROR_NULL, roadpose_frame_slice(NULL), "slice");
    expect(ROADPOSE_ERROR_NULL, roadpose_frame_pose(NULL, &pose), "pose, instance");
    expect(ROADPOSE_ERROR_NULL, roadpose_frame_pose(&instance, NULL), "pose, pose");
    expect(ROADPOSE_ERROR_NULL, roadpose_frame_cancel(NULL), "cancel");
    expect(ROADPOSE_ERROR_NULL, roadpose_process(NULL, &frame, &pose), "process, instance");
    expect(ROADPOSE_ERROR_NULL, roadpose_process(&instance, NULL, &pose), "process, frame");
    expect(ROADPOSE_ERROR_NULL, roadpose_process(&instance, &frame, NULL), "process, pose");
    frame.samples = NULL;
    expect(ROADPOSE_ERROR_NULL, roadpose_frame_begin(&instance, &frame), "begin, samples");
    expect(ROADPOSE_ERROR_NULL, roadpose_process(&instance, &frame, &pose), "process, samples");
    roadpose_settings_default(NULL);
    TEST_ASSERT_FALSE(roadpose_format_preset(NULL, ROADPOSE_FORMAT_VPI));
    TEST_ASSERT_FALSE(roadpose_is_free(NULL, 0, 0));
    TEST_ASSERT_EQUAL(0, roadpose_v_disparity_free(NULL, 0, 0));
}

static void test_confidence_image(void) {
    format.has_confidence_image = true;
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_init(&instance, &rig, &format, &settings));
    remember();
    expect(ROADPOSE_ERROR_NULL, roadpose_process(&instance, &frame, &pose), "no confidence image");
    frame.confidence = samples;
    frame.confidence_stride_bytes = 1279;
    expect(ROADPOSE_ERROR_STRIDE, roadpose_process(&instance, &frame, &pose), "confidence stride");
    frame.confidence_stride_bytes = 1280;
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_process(&instance, &frame, &pose));
}

static void expect_frame(roadpose_result_t wanted, const char *what) {
    remember();
    expect(wanted, roadpose_frame_begin(&instance, &frame), what);
    expect(wanted, roadpose_process(&instance, &frame, &pose), what);
    frame = frame_of(&rig, samples);
}

static void test_frames_that_do_not_fit(void) {
    frame.stride_bytes = 1279;
    expect_frame(ROADPOSE_ERROR_STRIDE, "stride one short");
    frame.stride_bytes = 0;
    expect_frame(ROADPOSE_ERROR_STRIDE, "stride 0");
    frame.width_px = 639;
    expect_frame(ROADPOSE_ERROR_SIZE, "narrower");
    frame.width_px = 641;
    frame.stride_bytes = 2000;
    expect_frame(ROADPOSE_ERROR_SIZE, "wider");
    frame.height_px = 481;
    expect_frame(ROADPOSE_ERROR_SIZE, "higher");
    frame.height_px = 0;
    expect_frame(ROADPOSE_ERROR_SIZE, "no rows");
}

static void test_calls_out_of_order(void) {
    remember();
    expect(ROADPOSE_ERROR_ORDER, roadpose_frame_slice(&instance), "slice before begin");
    expect(ROADPOSE_ERROR_ORDER, roadpose_frame_pose(&instance, &pose), "pose before a frame");
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_frame_begin(&instance, &frame));
    remember();
    expect(ROADPOSE_ERROR_ORDER, roadpose_frame_begin(&instance, &frame), "begin twice");
    expect(ROADPOSE_ERROR_ORDER, roadpose_process(&instance, &frame, &pose), "process while a frame runs");
    expect(ROADPOSE_ERROR_ORDER, roadpose_frame_pose(&instance, &pose), "pose while a frame runs");
    while (roadpose_frame_slice(&instance) == ROADPOSE_MORE) {
    }
    remember();
    expect(ROADPOSE_ERROR_ORDER, roadpose_frame_slice(&instance), "slice after the last");
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_frame_pose(&instance, &pose));
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_frame_pose(&instance, &pose)); /* as often as wanted */
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_frame_begin(&instance, &frame));
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_frame_cancel(&instance));
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_frame_cancel(&instance)); /* nothing to give up is no fault */
    remember();
    expect(ROADPOSE_ERROR_ORDER, roadpose_frame_pose(&instance, &pose), "pose after cancel");
}

static void test_memory_that_was_never_initialised(void) {
    for (int fill = 0; fill < 256; fill += 85) {
        memset(&instance, fill, sizeof instance);
        remember();
        expect(ROADPOSE_ERROR_ORDER, roadpose_frame_begin(&instance, &frame), "begin");
        expect(ROADPOSE_ERROR_ORDER, roadpose_frame_slice(&instance), "slice");
        expect(ROADPOSE_ERROR_ORDER, roadpose_frame_pose(&instance, &pose), "pose");
        expect(ROADPOSE_ERROR_ORDER, roadpose_frame_cancel(&instance), "cancel");
        expect(ROADPOSE_ERROR_ORDER, roadpose_process(&instance, &frame, &pose), "process");
    }
}

/* A refused init must not harm an instance that works. */
static void test_refused_init_keeps_the_running_frame(void) {
    roadpose_pose_t good, after;
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_process(&instance, &frame, &good));
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_frame_begin(&instance, &frame));
    BAD(rig, baseline_um, 0, ROADPOSE_ERROR_RIG);
    while (roadpose_frame_slice(&instance) == ROADPOSE_MORE) {
    }
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_frame_pose(&instance, &after));
    TEST_ASSERT_EQUAL(good.pitch_urad, after.pitch_urad);
}

static void test_defaults_are_as_documented(void) {
    TEST_ASSERT_EQUAL(2, settings.method);
    TEST_ASSERT_TRUE(settings.refine);
    TEST_ASSERT_EQUAL(100, settings.points_percent);
    TEST_ASSERT_EQUAL(1, settings.seed);
    TEST_ASSERT_EQUAL(2000, settings.corridor_half_width_mm);
    TEST_ASSERT_EQUAL(25000, settings.corridor_range_mm);
    TEST_ASSERT_EQUAL(-174533, settings.pitch_min_urad);
    TEST_ASSERT_EQUAL(261799, settings.pitch_max_urad);
    TEST_ASSERT_EQUAL(436332, settings.roll_max_urad);
    TEST_ASSERT_EQUAL(300000, settings.height_min_um);
    TEST_ASSERT_EQUAL(4000000, settings.height_max_um);
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_process(&instance, &frame, &pose_before));
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_init(&instance, &rig, &format, NULL)); /* NULL means the defaults */
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_process(&instance, &frame, &pose));
    TEST_ASSERT_EQUAL(pose_before.pitch_urad, pose.pitch_urad);
}

static void test_status_words(void) {
    static const char *const words[] = {"ok", "no_disparity", "no_road", "little_support", "short_range", "poor_fit",
                                        "outside_limits"};
    for (int i = 0; i < 256; i++)
        TEST_ASSERT_EQUAL_STRING(i < ROADPOSE_STATUS_COUNT ? words[i] : "unknown", roadpose_status_word((uint8_t)i));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_rig_out_of_range);
    RUN_TEST(test_format_out_of_range);
    RUN_TEST(test_settings_out_of_range);
    RUN_TEST(test_null_pointers);
    RUN_TEST(test_confidence_image);
    RUN_TEST(test_frames_that_do_not_fit);
    RUN_TEST(test_calls_out_of_order);
    RUN_TEST(test_memory_that_was_never_initialised);
    RUN_TEST(test_refused_init_keeps_the_running_frame);
    RUN_TEST(test_defaults_are_as_documented);
    RUN_TEST(test_status_words);
    return UNITY_END();
}
