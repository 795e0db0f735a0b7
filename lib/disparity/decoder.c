#include "disparity/decoder.h"

#include <stddef.h>
#include <string.h>

#define OFFSET_MAX_MILLIPX 16000
#define SIGN_BIT UINT16_C(0x8000)

static bool processor_is_big_endian(void) {
    const uint16_t probe = 1;
    return *(const uint8_t *)&probe == 0u;
}

/* Smallest confidence in place; a threshold above what the field can say makes every sample "no match". */
static uint16_t least_confidence(const roadpose_disparity_format_t *format, bool in_sample) {
    if (!in_sample) {
        return 0;
    }
    const uint32_t in_place = (uint32_t)format->confidence_min << format->confidence_shift;
    return (uint16_t)((in_place > UINT16_MAX) ? UINT16_MAX : in_place);
}

static bool fields_fit(const roadpose_disparity_format_t *format) {
    const bool value = format->value_bits >= 1u && format->value_bits <= 16u && format->value_shift <= 15u &&
                       format->value_bits + format->value_shift <= 16u;
    const bool fraction = format->fraction_bits <= 15u && format->fraction_bits <= format->value_bits;
    const bool invalid = !format->has_invalid || format->invalid_first <= format->invalid_last;
    const bool confidence = format->confidence_bits <= 15u && format->confidence_shift <= 15u &&
                            format->confidence_bits + format->confidence_shift <= 16u &&
                            !(format->has_confidence_image && format->confidence_bits != 0u);
    const bool offset =
        format->offset_millipx >= -OFFSET_MAX_MILLIPX && format->offset_millipx <= OFFSET_MAX_MILLIPX;
    return format->byte_order <= (uint8_t)ROADPOSE_BYTES_BIG && value && fraction && invalid && confidence && offset;
}

/* Negative samples are one more range of "no match". Only where the format has a range of its own besides does the loop
 * need the extra test of the sign. */
static void prepare_invalid(roadpose_decoder_t *decoder, const roadpose_disparity_format_t *format) {
    const bool sign_is_range = format->is_signed && (!format->has_invalid || format->invalid_first >= SIGN_BIT);
    decoder->sign_mask = (format->is_signed && !sign_is_range) ? SIGN_BIT : UINT16_C(0);
    decoder->invalid_first = sign_is_range ? SIGN_BIT : format->invalid_first;
    decoder->invalid_span = format->has_invalid ? format->invalid_last - format->invalid_first : -1;
    if (sign_is_range) {
        decoder->invalid_span = UINT16_MAX - SIGN_BIT;
    }
}

bool roadpose_decoder_prepare(roadpose_decoder_t *decoder, const roadpose_disparity_format_t *format) {
    if (!fields_fit(format)) {
        return false;
    }
    const bool big = format->byte_order == (uint8_t)ROADPOSE_BYTES_BIG;
    const bool native = format->byte_order == (uint8_t)ROADPOSE_BYTES_NATIVE;
    const unsigned field_bits = (unsigned)format->value_shift + format->fraction_bits; /* <= 16 */
    const uint32_t value_ones = (UINT32_C(1) << format->value_bits) - 1u;
    const uint32_t confidence_ones = (UINT32_C(1) << format->confidence_bits) - 1u;
    const bool in_sample = format->confidence_bits != 0u;
    decoder->swap_bytes = !native && big != processor_is_big_endian();
    decoder->value_mask = (uint16_t)(value_ones << format->value_shift);
    decoder->value_scale = UINT32_C(1) << (16u - field_bits);
    prepare_invalid(decoder, format);
    decoder->confidence_mask = (uint16_t)(confidence_ones << format->confidence_shift);
    decoder->confidence_min = least_confidence(format, in_sample);
    decoder->image_confidence_min = format->confidence_min;
    /* |offset| <= 16 000, so the product is below 2^23; the half rounds to the nearest 1/256 px. */
    const int32_t half = (format->offset_millipx >= 0) ? 500 : -500;
    decoder->offset_q8 = (format->offset_millipx * 256 + half) / 1000;
    return true;
}

static inline uint16_t sample_at(const uint8_t *bytes, bool swap_bytes) {
    uint16_t sample;
    memcpy(&sample, bytes, sizeof sample); /* any alignment; compilers make one load of it */
    return swap_bytes ? (uint16_t)((uint32_t)sample >> 8 | (uint32_t)sample << 8) : sample;
}

/* Sign and confidence inside the sample; formats without either skip the test. */
static inline bool is_doubtful(const roadpose_decoder_t *decoder, uint32_t sample) {
    return (sample & decoder->sign_mask) != 0u || (sample & decoder->confidence_mask) < decoder->confidence_min;
}

/* Q8 disparity of a sample, 0 for no match. Value and scale: (2^16 - 1) * 2^16 + 128 < 2^32; the 128 rounds. */
static inline uint16_t disparity_q8(const roadpose_decoder_t *decoder, uint32_t sample) {
    const uint32_t scaled = (sample & decoder->value_mask) * decoder->value_scale;
    const int32_t q8 = (int32_t)((scaled + 128u) >> 8) + decoder->offset_q8; /* < 2^24 + 2^13 */
    const bool no_match = (int32_t)((sample - decoder->invalid_first) & UINT16_MAX) <= decoder->invalid_span;
    /* one unsigned comparison for 1 <= q8 < limit */
    const bool in_range = (uint32_t)q8 - 1u < (uint32_t)ROADPOSE_MAX_DISPARITY * 256u - 1u;
    return (uint16_t)((in_range && !no_match) ? q8 : 0);
}

/* Inlined with constants for the flags: a loop of its own for each kind of format. */
static inline void decode(const roadpose_decoder_t *decoder, const uint8_t *bytes, int16_t columns, bool swap_bytes,
                          bool test_doubt, uint16_t *out_q8) {
    const roadpose_decoder_t d = *decoder; /* a copy that out_q8 cannot alias: the loop keeps it in registers */
    uint16_t *const end = out_q8 + columns;
    for (; out_q8 != end; out_q8++) {
        const uint32_t sample = sample_at(bytes, swap_bytes);
        *out_q8 = (test_doubt && is_doubtful(&d, sample)) ? 0u : disparity_q8(&d, sample);
        bytes += 2 * ROADPOSE_COLUMN_STEP;
    }
}

static void drop_unconfident(const roadpose_decoder_t *decoder, const uint8_t *bytes, int16_t columns,
                             uint16_t *out_q8) {
    for (int16_t i = 0; i < columns; i++) {
        if (sample_at(bytes, decoder->swap_bytes) < decoder->image_confidence_min) {
            out_q8[i] = 0;
        }
        bytes += 2 * ROADPOSE_COLUMN_STEP;
    }
}

void roadpose_decode_row(const roadpose_decoder_t *decoder, const roadpose_frame_t *frame, uint32_t row,
                         int16_t columns, uint16_t *out_q8) {
    const uint8_t *bytes = (const uint8_t *)frame->samples + (size_t)row * frame->stride_bytes;
    if (decoder->sign_mask != 0u || decoder->confidence_min != 0u) {
        decode(decoder, bytes, columns, decoder->swap_bytes, true, out_q8);
    } else if (decoder->swap_bytes) {
        decode(decoder, bytes, columns, true, false, out_q8);
    } else {
        decode(decoder, bytes, columns, false, false, out_q8);
    }
    if (frame->confidence != NULL) {
        bytes = (const uint8_t *)frame->confidence + (size_t)row * frame->confidence_stride_bytes;
        drop_unconfident(decoder, bytes, columns, out_q8);
    }
}
