#include "disparity/decoder.h"

#include <stddef.h>

#include "fixed_point/fixed_point.h"

#define Q8_BITS 8u
#define OFFSET_MAX_MILLIPX 16000

static bool processor_is_big_endian(void) {
    const uint16_t probe = 1;
    return *(const uint8_t *)&probe == 0u;
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

bool roadpose_decoder_prepare(roadpose_decoder_t *decoder, const roadpose_disparity_format_t *format) {
    if (!fields_fit(format)) {
        return false;
    }
    const bool native_big = format->byte_order == (uint8_t)ROADPOSE_BYTES_NATIVE && processor_is_big_endian();
    const unsigned fraction = format->fraction_bits;
    decoder->first_byte_is_high = (native_big || format->byte_order == (uint8_t)ROADPOSE_BYTES_BIG) ? 1u : 0u;
    decoder->value_shift = format->value_shift;
    decoder->up_shift = (uint8_t)((fraction < Q8_BITS) ? (Q8_BITS - fraction) : 0u);
    decoder->down_shift = (uint8_t)((fraction > Q8_BITS) ? (fraction - Q8_BITS) : 0u);
    decoder->value_mask = (uint16_t)((UINT32_C(1) << format->value_bits) - 1u);
    decoder->sign_mask = format->is_signed ? UINT16_C(0x8000) : UINT16_C(0);
    decoder->has_invalid = format->has_invalid ? 1u : 0u;
    decoder->invalid_first = format->invalid_first;
    decoder->invalid_span = (uint16_t)(format->invalid_last - format->invalid_first);
    decoder->confidence_shift = format->confidence_shift;
    decoder->confidence_mask = (uint16_t)((UINT32_C(1) << format->confidence_bits) - 1u);
    decoder->confidence_min = format->confidence_min;
    /* |offset| <= 16 000, so the product is below 2^23; the half rounds to the nearest 1/256 px. */
    decoder->offset_q8 = (int32_t)roadpose_floor_shift(((int64_t)format->offset_millipx * 512) / 1000 + 1, 1u);
    decoder->limit_q8 = ROADPOSE_MAX_DISPARITY * 256;
    return true;
}

static inline uint16_t sample_at(const roadpose_decoder_t *decoder, const uint8_t *bytes) {
    const unsigned first = bytes[0];
    const unsigned second = bytes[1];
    return (uint16_t)((decoder->first_byte_is_high != 0u) ? ((first << 8) | second) : ((second << 8) | first));
}

static inline bool is_match(const roadpose_decoder_t *decoder, uint16_t sample) {
    const bool invalid = decoder->has_invalid != 0u &&
                         (uint16_t)(sample - decoder->invalid_first) <= decoder->invalid_span;
    const bool confident = decoder->confidence_mask == 0u ||
                           ((sample >> decoder->confidence_shift) & decoder->confidence_mask) >=
                               decoder->confidence_min;
    return (sample & decoder->sign_mask) == 0u && !invalid && confident;
}

/* Q8 disparity of a sample, 0 for no match. value < 2^16 and up_shift <= 8, so value << up_shift < 2^24. */
static inline uint16_t disparity_q8(const roadpose_decoder_t *decoder, uint16_t sample) {
    if (!is_match(decoder, sample)) {
        return 0;
    }
    const uint32_t value = ((uint32_t)sample >> decoder->value_shift) & decoder->value_mask;
    const uint32_t half = (UINT32_C(1) << decoder->down_shift) >> 1;
    const int32_t q8 = (int32_t)(((value << decoder->up_shift) + half) >> decoder->down_shift) + decoder->offset_q8;
    return (uint16_t)((q8 > 0 && q8 < decoder->limit_q8) ? q8 : 0);
}

static void drop_unconfident(const roadpose_decoder_t *decoder, const roadpose_frame_t *frame, uint32_t row,
                             int16_t columns, uint16_t *out_q8) {
    const uint8_t *bytes = (const uint8_t *)frame->confidence + (size_t)row * frame->confidence_stride_bytes;
    for (int16_t i = 0; i < columns; i++) {
        if (sample_at(decoder, bytes) < decoder->confidence_min) {
            out_q8[i] = 0;
        }
        bytes += 2 * ROADPOSE_COLUMN_STEP;
    }
}

void roadpose_decode_row(const roadpose_decoder_t *decoder, const roadpose_frame_t *frame, uint32_t row,
                         int16_t columns, uint16_t *out_q8) {
    const roadpose_decoder_t d = *decoder; /* a copy: out_q8 may not alias it, so the loop keeps it in registers */
    const uint8_t *bytes = (const uint8_t *)frame->samples + (size_t)row * frame->stride_bytes;
    for (int16_t i = 0; i < columns; i++) {
        out_q8[i] = disparity_q8(&d, sample_at(&d, bytes));
        bytes += 2 * ROADPOSE_COLUMN_STEP;
    }
    if (frame->confidence != NULL) {
        drop_unconfident(decoder, frame, row, columns, out_q8);
    }
}
