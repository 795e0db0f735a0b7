/* Any content of the buffers, any valid rig, format and settings: a status, bounded work, nothing else touched. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "guarded_buffer.h"
#include "pose_checks.h"
#include "random_numbers.h"
#include "roadpose/roadpose.h"
#include "synthetic.h"
#include "unity.h"

enum { CASES = 400, CONTENTS = 9 };

/* Most cases are small images, which are quick. */
#define SMALL_WIDTH (ROADPOSE_MAX_WIDTH < 320 ? ROADPOSE_MAX_WIDTH : 320)
#define SMALL_HEIGHT (ROADPOSE_MAX_HEIGHT < 240 ? ROADPOSE_MAX_HEIGHT : 240)

static guarded_buffer_t memory; /* the instance lives between guards too */
static roadpose_t *instance;
static random_numbers_t numbers;

void setUp(void) {
    memory = guarded_buffer(sizeof(roadpose_t), 0);
    instance = (roadpose_t *)(void *)memory.bytes;
}

void tearDown(void) { free_guarded_buffer(&memory); }

static int32_t within(int64_t low, int64_t high) {
    /* every fourth draw is an end of the range */
    const int64_t kind = random_between(&numbers, 0, 7);
    return (int32_t)(kind == 0 ? low : kind == 1 ? high : random_between(&numbers, low, high));
}

static roadpose_rig_t random_rig(void) {
    roadpose_rig_t rig;
    memset(&rig, 0, sizeof rig);
    rig.width_px = (uint16_t)within(64, random_between(&numbers, 0, 3) ? SMALL_WIDTH : ROADPOSE_MAX_WIDTH);
    rig.height_px = (uint16_t)within(64, random_between(&numbers, 0, 3) ? SMALL_HEIGHT : ROADPOSE_MAX_HEIGHT);
    rig.focal_millipx = within(50000, 4000000);
    rig.cu_millipx = within(0, 1000 * (rig.width_px - 1));
    rig.cv_millipx = within(0, 1000 * (rig.height_px - 1));
    rig.baseline_um = within(20000, 2000000);
    return rig;
}

static roadpose_disparity_format_t random_format(void) {
    roadpose_disparity_format_t format;
    TEST_ASSERT_TRUE(roadpose_format_preset(&format, (roadpose_format_preset_t)within(0, 5)));
    if (random_between(&numbers, 0, 1)) {
        format.byte_order = (uint8_t)within(0, 2);
        format.is_signed = random_between(&numbers, 0, 1);
        format.value_bits = (uint8_t)within(1, 16);
        format.value_shift = (uint8_t)within(0, format.value_bits > 1 ? 16 - format.value_bits : 15);
        format.fraction_bits = (uint8_t)within(0, format.value_bits < 15 ? format.value_bits : 15);
        format.has_invalid = random_between(&numbers, 0, 1);
        format.invalid_first = (uint16_t)within(0, 65535);
        format.invalid_last = (uint16_t)within(format.invalid_first, 65535);
        format.confidence_bits = (uint8_t)within(0, 15);
        format.confidence_shift = (uint8_t)within(0, 16 - format.confidence_bits);
        if (format.confidence_shift > 15) format.confidence_shift = 15;
        format.has_confidence_image = format.confidence_bits == 0 && random_between(&numbers, 0, 1);
        format.confidence_min = (uint16_t)within(0, 65535);
    }
    format.offset_millipx = within(-16000, 16000);
    return format;
}

static roadpose_settings_t random_settings(void) {
    roadpose_settings_t settings;
    roadpose_settings_default(&settings);
    settings.method = (uint8_t)within(1, 2);
    settings.refine = random_between(&numbers, 0, 1);
    settings.points_percent = (uint8_t)within(1, 100);
    settings.seed = (uint32_t)random_bits(&numbers);
    settings.corridor_half_width_mm = random_between(&numbers, 0, 1) ? 0 : within(500, 100000);
    settings.corridor_range_mm = random_between(&numbers, 0, 1) ? 0 : within(5000, 500000);
    settings.obstacle_height_mm = random_between(&numbers, 0, 1) ? 0 : within(100, 5000);
    settings.noise_millipx = within(100, 3000);
    settings.unevenness_mm = within(0, 200);
    settings.pitch_min_urad = within(-523599, 0);
    settings.pitch_max_urad = within(0, 523599);
    settings.roll_max_urad = within(0, 610865);
    settings.height_min_um = within(200000, 1000000);
    settings.height_max_um = within(1000000, 5000000);
    settings.points_min = (uint16_t)within(16, ROADPOSE_MAX_POINTS);
    settings.support_min_permille = (uint16_t)within(0, 1000);
    settings.range_min_mm = within(0, 50000);
    return settings;
}

static void fill_words(uint8_t *bytes, size_t count, uint16_t even, uint16_t odd) {
    for (size_t i = 0; i + 1 < count; i += 2) {
        const uint16_t word = (i / 2) % 2 ? odd : even;
        memcpy(bytes + i, &word, 2);
    }
}

/* Rows of one value each, rising and falling: planes of any slope in any format. */
static void fill_ramp(uint8_t *bytes, size_t count, size_t stride) {
    const uint32_t step = (uint32_t)random_any_magnitude(&numbers, 12), start = (uint32_t)random_bits(&numbers);
    for (size_t i = 0; i + 1 < count; i += 2) {
        const uint16_t word = (uint16_t)(start + step * (uint32_t)(i / stride));
        memcpy(bytes + i, &word, 2);
    }
}

static void fill_few_bits(uint8_t *bytes, size_t count) {
    for (size_t i = 0; i + 1 < count; i += 2) {
        const uint16_t word = (uint16_t)random_any_magnitude(&numbers, 16);
        memcpy(bytes + i, &word, 2);
    }
}

static void fill(int content, uint8_t *bytes, size_t count, size_t stride) {
    switch (content) {
    case 0: random_bytes(&numbers, bytes, count); break;
    case 1: memset(bytes, 0, count); break;
    case 2: memset(bytes, 0xFF, count); break;
    case 3: fill_words(bytes, count, 0x7FFF, 0x8000); break;
    case 4: fill_words(bytes, count, 0, 0xFFFF); break;
    case 5: fill_words(bytes, count, 1, 1); break;
    case 6: fill_words(bytes, count, (uint16_t)random_bits(&numbers), (uint16_t)random_bits(&numbers)); break;
    case 7: fill_few_bits(bytes, count); break;
    default: fill_ramp(bytes, count, stride); break;
    }
}

static guarded_buffer_t random_image(const roadpose_rig_t *rig, int content, uint32_t *stride) {
    *stride = 2u * rig->width_px + (uint32_t)within(0, 9);
    /* exactly the bytes that belong to the image: nothing after the last sample of the last row */
    guarded_buffer_t image = guarded_buffer((size_t)*stride * (rig->height_px - 1u) + 2u * rig->width_px,
                                            (size_t)random_between(&numbers, 0, 3));
    fill(content, image.bytes, image.count, *stride);
    return image;
}

static roadpose_pose_t run(const roadpose_frame_t *frame) {
    roadpose_pose_t pose;
    uint32_t slices = 1;
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_frame_begin(instance, frame));
    roadpose_result_t result;
    while ((result = roadpose_frame_slice(instance)) == ROADPOSE_MORE) TEST_ASSERT_TRUE(++slices <= roadpose_slices_max());
    TEST_ASSERT_EQUAL(ROADPOSE_OK, result);
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_frame_pose(instance, &pose));
    return pose;
}

static void try_case(int number) {
    const roadpose_rig_t rig = random_rig();
    const roadpose_disparity_format_t format = random_format();
    const roadpose_settings_t settings = random_settings();
    roadpose_frame_t frame = frame_of(&rig, NULL);
    guarded_buffer_t image = random_image(&rig, number % CONTENTS, &frame.stride_bytes);
    guarded_buffer_t confidence = random_image(&rig, 0, &frame.confidence_stride_bytes);
    char text[120];
    frame.samples = image.bytes;
    frame.confidence = format.has_confidence_image ? confidence.bytes : NULL;
    snprintf(text, sizeof text, "case %d", number);
    TEST_ASSERT_EQUAL_MESSAGE(ROADPOSE_OK, roadpose_init(instance, &rig, &format, &settings), text);
    const roadpose_pose_t pose = run(&frame);
    const char *fault = pose_fault(&pose, &settings);
    snprintf(text, sizeof text, "case %d (%s): %s", number, roadpose_status_word(pose.status), fault ? fault : "");
    TEST_ASSERT_NULL_MESSAGE(fault, text);
    TEST_ASSERT_TRUE_MESSAGE(guards_are_whole(&image) && guards_are_whole(&confidence), "the image was written to");
    TEST_ASSERT_TRUE_MESSAGE(guards_are_whole(&memory), "written beyond the instance");
    free_guarded_buffer(&image);
    free_guarded_buffer(&confidence);
}

static void test_any_buffer(void) {
    numbers = random_numbers("any buffer");
    for (int number = 0; number < CASES; number++) try_case(number);
}

/* With the default settings, what is no road is never taken for one. */
static void test_contents_that_are_no_road(void) {
    numbers = random_numbers("no road");
    roadpose_rig_t rig = rig_640x480();
    rig.width_px = rig.width_px < ROADPOSE_MAX_WIDTH ? rig.width_px : ROADPOSE_MAX_WIDTH;
    rig.height_px = rig.height_px < ROADPOSE_MAX_HEIGHT ? rig.height_px : ROADPOSE_MAX_HEIGHT;
    rig.cu_millipx = 500 * rig.width_px;
    rig.cv_millipx = 500 * rig.height_px;
    for (int preset = 0; preset <= 5; preset++)
        for (int content = 0; content < 8; content++) {
            roadpose_disparity_format_t format;
            roadpose_frame_t frame = frame_of(&rig, NULL);
            guarded_buffer_t image = random_image(&rig, content, &frame.stride_bytes);
            frame.samples = frame.confidence = image.bytes;
            frame.confidence_stride_bytes = frame.stride_bytes;
            TEST_ASSERT_TRUE(roadpose_format_preset(&format, (roadpose_format_preset_t)preset));
            if (!format.has_confidence_image) frame.confidence = NULL;
            TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_init(instance, &rig, &format, NULL));
            const roadpose_pose_t pose = run(&frame);
            TEST_ASSERT_NOT_EQUAL(ROADPOSE_STATUS_OK, pose.status);
            if (content == 1) TEST_ASSERT_EQUAL(ROADPOSE_STATUS_NO_DISPARITY, pose.status);
            free_guarded_buffer(&image);
        }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_any_buffer);
    RUN_TEST(test_contents_that_are_no_road);
    return UNITY_END();
}
