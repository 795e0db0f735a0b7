#include "disparity/decoder.h"

#include <stddef.h>

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

/* Q8 disparity of a sample whose bits all count. sample < 2^16 and scale <= 2^16: below 2^32 with the half. */
static int32_t plain_q8(const roadpose_decoder_t *decoder, uint32_t sample) {
    return (int32_t)((sample * decoder->value_scale + 128u) >> 8) + decoder->offset_q8;
}

/* First sample below `end` whose disparity reaches q8, else `end`: it never falls from one sample to the next. */
static uint32_t first_reaching(const roadpose_decoder_t *decoder, uint32_t end, int32_t q8) {
    uint32_t low = 0;
    uint32_t high = end;
    while (low < high) {
        const uint32_t middle = (low + high) / 2u;
        if (plain_q8(decoder, middle) >= q8) {
            high = middle;
        } else {
            low = middle + 1u;
        }
    }
    return low;
}

/* Nearly every format is plain: samples above the field are no match, and the range of "no match" takes off one end of
 * those that carry a disparity. Then one comparison tells a match. */
static void prepare_plain(roadpose_decoder_t *decoder) {
    const uint32_t invalid_first = decoder->invalid_first;
    const uint32_t invalid_end = (uint32_t)((int32_t)invalid_first + decoder->invalid_span + 1); /* exclusive, <= 2^16 */
    const uint32_t field_end = (uint32_t)decoder->value_mask + 1u;
    const bool above_is_invalid = field_end > UINT16_MAX || (invalid_first <= field_end && invalid_end > UINT16_MAX);
    uint32_t first = first_reaching(decoder, field_end, 1);
    uint32_t end = first_reaching(decoder, field_end, ROADPOSE_MAX_DISPARITY * 256);
    const bool cuts_first = invalid_first <= first;
    const bool cuts_end = invalid_end >= end;
    if (cuts_first && invalid_end > first) {
        first = invalid_end;
    } else if (cuts_end && invalid_first < end) {
        end = invalid_first;
    }
    const bool has_low_bits = (decoder->value_mask & 1u) != 0u;
    decoder->is_plain = has_low_bits && above_is_invalid && (cuts_first || cuts_end) && decoder->sign_mask == 0u &&
                        decoder->confidence_min == 0u;
    decoder->plain_first = (first < end) ? first : UINT32_C(1) << 16; /* none: beyond every sample */
    decoder->plain_span = (first < end) ? end - first - 1u : 0u;
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
    prepare_plain(decoder);
    return true;
}

/* Sign and confidence inside the sample. */
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

/* The copy of the decoder cannot be aliased by out_q8: the loop keeps it in registers. */
static void decode(const roadpose_decoder_t *decoder, const uint8_t *bytes, int16_t columns, uint16_t *out_q8) {
    const roadpose_decoder_t d = *decoder;
    const uint16_t *const end = out_q8 + columns;
    for (; out_q8 != end; out_q8++) {
        const uint32_t sample = roadpose_sample_at(bytes, d.swap_bytes);
        *out_q8 = is_doubtful(&d, sample) ? 0u : disparity_q8(&d, sample);
        bytes += 2 * ROADPOSE_COLUMN_STEP;
    }
}

static void drop_unconfident(const roadpose_decoder_t *decoder, const uint8_t *bytes, int16_t columns,
                             uint16_t *out_q8) {
    for (int16_t i = 0; i < columns; i++) {
        if (roadpose_sample_at(bytes, decoder->swap_bytes) < decoder->image_confidence_min) {
            out_q8[i] = 0;
        }
        bytes += 2 * ROADPOSE_COLUMN_STEP;
    }
}

/* Rounding and offset in one addend, which may be negative and wrap: the sum of a sample that counts is positive. */
static void read_in_place(roadpose_row_t *samples, const roadpose_decoder_t *decoder, const uint8_t *bytes) {
    samples->next = bytes;
    samples->step_bytes = 2 * ROADPOSE_COLUMN_STEP;
    samples->swap_bytes = decoder->swap_bytes;
    samples->first = decoder->plain_first;
    samples->span = decoder->plain_span;
    samples->scale = decoder->value_scale;
    samples->addend = 128u + (uint32_t)decoder->offset_q8 * 256u;
}

static void read_decoded(roadpose_row_t *samples, const uint16_t *row_q8) {
    samples->next = (const uint8_t *)row_q8;
    samples->step_bytes = sizeof row_q8[0];
    samples->swap_bytes = false;
    samples->first = 1;
    samples->span = UINT16_MAX - 1u;
    samples->scale = 256;
    samples->addend = 0;
}

void roadpose_row_begin(roadpose_row_t *samples, const roadpose_decoder_t *decoder, const roadpose_frame_t *frame,
                        uint32_t row, int16_t columns, uint16_t *out_q8) {
    const uint8_t *bytes = (const uint8_t *)frame->samples + (size_t)row * frame->stride_bytes;
    if (decoder->is_plain && frame->confidence == NULL) {
        read_in_place(samples, decoder, bytes);
        return;
    }
    decode(decoder, bytes, columns, out_q8);
    if (frame->confidence != NULL) {
        bytes = (const uint8_t *)frame->confidence + (size_t)row * frame->confidence_stride_bytes;
        drop_unconfident(decoder, bytes, columns, out_q8);
    }
    read_decoded(samples, out_q8);
}
