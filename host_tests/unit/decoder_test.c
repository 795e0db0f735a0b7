/* Every one of the 65 536 samples, in every preset and in many formats, against the format's definition in doubles. */
#include "disparity/decoder.h"

#include <stdlib.h>
#include <string.h>

#include "lsb.h"
#include "random_numbers.h"
#include "synthetic.h"

enum { FORMATS = 60, CHUNK = ROADPOSE_MAX_GRID_COLUMNS, ALL = 65536 };

static uint8_t samples[2 * ALL * ROADPOSE_COLUMN_STEP];
static uint8_t confidence[2 * ALL * ROADPOSE_COLUMN_STEP];
static uint16_t decoded[ALL];
static random_numbers_t numbers;

void setUp(void) { numbers = random_numbers("decoder"); }
void tearDown(void) {}

static void put(uint8_t *image, unsigned index, unsigned value, uint8_t byte_order) {
    uint8_t *at = image + 2 * (size_t)index * ROADPOSE_COLUMN_STEP;
    const uint16_t native = (uint16_t)value;
    if (byte_order == ROADPOSE_BYTES_NATIVE) memcpy(at, &native, 2);
    at[0] = byte_order == ROADPOSE_BYTES_BIG ? (uint8_t)(value >> 8) : byte_order == ROADPOSE_BYTES_LITTLE ? (uint8_t)value : at[0];
    at[1] = byte_order == ROADPOSE_BYTES_BIG ? (uint8_t)value : byte_order == ROADPOSE_BYTES_LITTLE ? (uint8_t)(value >> 8) : at[1];
}

static void take_row(const roadpose_decoder_t *decoder, const roadpose_frame_t *frame, uint32_t row, unsigned count,
                     uint16_t *out_q8) {
    static uint16_t buffer[CHUNK + 1];
    roadpose_row_t reader;
    buffer[count] = 0xEEEE;
    roadpose_row_begin(&reader, decoder, frame, row, (int16_t)count, buffer);
    for (unsigned i = 0; i < count; i++) {
        uint32_t disparity_q16;
        out_q8[i] = (uint16_t)(roadpose_row_take(&reader, reader.swap_bytes, &disparity_q16) ? disparity_q16 >> 8 : 0);
    }
    TEST_ASSERT_EQUAL_HEX16(0xEEEE, buffer[count]);
}

static void decode_all(const roadpose_disparity_format_t *format) {
    roadpose_decoder_t decoder;
    TEST_ASSERT_TRUE(roadpose_decoder_prepare(&decoder, format));
    for (unsigned first = 0; first < ALL; first += CHUNK) {
        const unsigned count = ALL - first < CHUNK ? ALL - first : CHUNK;
        const size_t at = 2 * (size_t)first * ROADPOSE_COLUMN_STEP;
        roadpose_frame_t frame;
        memset(&frame, 0, sizeof frame);
        frame.samples = samples + at;
        frame.confidence = format->has_confidence_image ? confidence + at : NULL;
        take_row(&decoder, &frame, 0, count, decoded + first);
    }
}

/* The definition in include/roadpose/disparity.h, word for word. Returns pixels; 0 = no match. */
static double defined(const roadpose_disparity_format_t *format, unsigned s, unsigned image_confidence) {
    if (format->is_signed && s >> 15) return 0;
    if (format->has_invalid && format->invalid_first <= s && s <= format->invalid_last) return 0;
    if (format->confidence_bits > 0 &&
        fmod(floor(ldexp(s, -format->confidence_shift)), ldexp(1, format->confidence_bits)) < format->confidence_min)
        return 0;
    if (format->has_confidence_image && image_confidence < format->confidence_min) return 0;
    const double field = fmod(floor(ldexp(s, -format->value_shift)), ldexp(1, format->value_bits));
    return ldexp(field, -format->fraction_bits) + format->offset_millipx / 1000.0;
}

/* Exact where the format has up to 8 fraction bits and no offset; else 0.5 LSB for rounding the disparity to 1/256 px
 * and 0.5 for rounding the offset. At the ends (0 and the limit) either side of the rounding may be taken. */
static void check_sample(const roadpose_disparity_format_t *format, unsigned s, unsigned image_confidence) {
    const double pixels = defined(format, s, image_confidence), q8 = 256 * pixels;
    const double tolerance = (format->fraction_bits > 8 ? 0.5 : 0) + (format->offset_millipx ? 0.5 : 0);
    const double limit = ROADPOSE_MAX_DISPARITY * 256.0;
    char text[60];
    if (decoded[s] == 0 && (pixels == 0 || q8 <= tolerance || q8 >= limit - tolerance)) return;
    snprintf(text, sizeof text, "sample 0x%04X", s);
    ASSERT_LSB(pixels == 0 ? 0 : tolerance, q8, decoded[s], text);
    TEST_ASSERT_TRUE(decoded[s] < limit);
}

static void check_format(const roadpose_disparity_format_t *format) {
    static uint16_t image_confidence[ALL];
    for (unsigned s = 0; s < ALL; s++) {
        image_confidence[s] = (uint16_t)random_bits(&numbers);
        put(samples, s, s, format->byte_order);
        put(confidence, s, image_confidence[s], format->byte_order);
    }
    decode_all(format);
    for (unsigned s = 0; s < ALL; s++) check_sample(format, s, image_confidence[s]);
}

static void test_presets(void) {
    for (int preset = 0; preset <= 5; preset++)
        for (int offset = -16000; offset <= 16000; offset += 8000) {
            roadpose_disparity_format_t format;
            TEST_ASSERT_TRUE(roadpose_format_preset(&format, (roadpose_format_preset_t)preset));
            format.offset_millipx = offset + (offset ? 37 : 0);
            if (offset == 16000 || offset == -16000) format.offset_millipx = offset;
            check_format(&format);
        }
}

static roadpose_disparity_format_t random_format(void) {
    roadpose_disparity_format_t format;
    memset(&format, 0, sizeof format);
    format.byte_order = (uint8_t)random_between(&numbers, 0, 2);
    format.is_signed = random_between(&numbers, 0, 1);
    format.value_bits = (uint8_t)random_between(&numbers, 1, 16);
    format.value_shift = (uint8_t)random_between(&numbers, 0, format.value_bits == 1 ? 15 : 16 - format.value_bits);
    format.fraction_bits = (uint8_t)random_between(&numbers, 0, format.value_bits < 15 ? format.value_bits : 15);
    format.has_invalid = random_between(&numbers, 0, 1);
    format.invalid_first = (uint16_t)random_bits(&numbers);
    format.invalid_last = (uint16_t)random_between(&numbers, format.invalid_first, 65535);
    format.confidence_bits = (uint8_t)random_between(&numbers, 0, 8);
    format.confidence_shift = (uint8_t)random_between(&numbers, 0, format.confidence_bits ? 16 - format.confidence_bits : 15);
    format.has_confidence_image = format.confidence_bits == 0 && random_between(&numbers, 0, 1);
    format.confidence_min = (uint16_t)random_any_magnitude(&numbers, format.has_confidence_image ? 16 : 9);
    if (random_between(&numbers, 0, 1)) format.offset_millipx = (int32_t)random_between(&numbers, -16000, 16000);
    return format;
}

static void test_any_format(void) {
    for (int i = 0; i < FORMATS; i++) {
        const roadpose_disparity_format_t format = random_format();
        check_format(&format);
    }
}

/* Only every COLUMN_STEP-th sample of the asked row is read. */
static void test_rows_and_columns(void) {
    enum { WIDTH = 80, STRIDE = 2 * WIDTH + 5 };
    const int16_t columns = WIDTH / ROADPOSE_COLUMN_STEP;
    roadpose_disparity_format_t format = format_u16_q8();
    roadpose_decoder_t decoder;
    roadpose_frame_t frame;
    memset(&frame, 0, sizeof frame);
    for (unsigned v = 0; v < 8; v++)
        for (unsigned u = 0; u < WIDTH; u++) {
            const uint16_t sample = (uint16_t)(100 * v + u + 1);
            memcpy(samples + v * STRIDE + 2 * u, &sample, 2);
        }
    frame.samples = samples;
    frame.stride_bytes = STRIDE;
    TEST_ASSERT_TRUE(roadpose_decoder_prepare(&decoder, &format));
    take_row(&decoder, &frame, 5, (unsigned)columns, decoded);
    for (int i = 0; i < columns; i++) TEST_ASSERT_EQUAL_UINT16(500 + i * ROADPOSE_COLUMN_STEP + 1, decoded[i]);
    format.value_shift = 3; /* no longer plain: decoded into a buffer first */
    format.value_bits = 13;
    format.fraction_bits = 5;
    TEST_ASSERT_TRUE(roadpose_decoder_prepare(&decoder, &format));
    take_row(&decoder, &frame, 5, (unsigned)columns, decoded);
    for (int i = 0; i < columns; i++) TEST_ASSERT_EQUAL_UINT16((500 + i * ROADPOSE_COLUMN_STEP + 1) / 8 * 8, decoded[i]);
}

static void test_refused_format_leaves_the_decoder(void) {
    roadpose_disparity_format_t format = format_u16_q8();
    roadpose_decoder_t decoder, before;
    memset(&decoder, 0x5C, sizeof decoder);
    memcpy(&before, &decoder, sizeof before);
    format.value_bits = 17;
    TEST_ASSERT_FALSE(roadpose_decoder_prepare(&decoder, &format));
    TEST_ASSERT_EQUAL(0, memcmp(&before, &decoder, sizeof before));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_presets);
    RUN_TEST(test_any_format);
    RUN_TEST(test_rows_and_columns);
    RUN_TEST(test_refused_format_leaves_the_decoder);
    return UNITY_END();
}
