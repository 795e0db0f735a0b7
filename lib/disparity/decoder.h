/* From raw samples to disparities in Q8 pixels. */
#ifndef ROADPOSE_DECODER_H
#define ROADPOSE_DECODER_H

#include <string.h>

#include "roadpose/state.h"

/* Prepares *decoder for a format. Returns false, with *decoder unchanged, when a field is out of range. */
bool roadpose_decoder_prepare(roadpose_decoder_t *decoder, const roadpose_disparity_format_t *format);

/* One row of samples to be read from left to right. A disparity is what lies in one range of samples. */
typedef struct {
    const uint8_t *next;
    uint32_t step_bytes;
    bool swap_bytes;
    uint32_t first;  /* no match where sample - first > span, unsigned */
    uint32_t span;
    uint32_t scale;  /* Q8 disparity: (sample * scale + addend) / 256 */
    uint32_t addend;
} roadpose_row_t;

/* Begins every ROADPOSE_COLUMN_STEP-th sample of pixel row `row`: where the format allows it in the frame's own buffer,
 * else decoded into out_q8[columns], which must last as long as *samples. frame->confidence is used where not NULL. */
void roadpose_row_begin(roadpose_row_t *samples, const roadpose_decoder_t *decoder, const roadpose_frame_t *frame,
                        uint32_t row, int16_t columns, uint16_t *out_q8);

static inline uint32_t roadpose_sample_at(const uint8_t *bytes, bool swap_bytes) {
    uint16_t sample;
    memcpy(&sample, bytes, sizeof sample); /* any alignment; compilers make one load of it */
    return swap_bytes ? (uint16_t)((uint32_t)sample >> 8 | (uint32_t)sample << 8) : sample;
}

/* Takes the next sample; false: no match. disparity_q16: its disparity, whose low 8 bits are no part of Q8 and mean
 * nothing. swap_bytes: samples->swap_bytes, a constant where the caller has a loop for each.
 * A sample that counts is below 2^24, whatever wraps for others: Q8 disparities are below 2^16. */
static inline bool roadpose_row_take(roadpose_row_t *samples, bool swap_bytes, uint32_t *disparity_q16) {
    const uint32_t sample = roadpose_sample_at(samples->next, swap_bytes);
    samples->next += samples->step_bytes;
    *disparity_q16 = sample * samples->scale + samples->addend;
    return sample - samples->first <= samples->span;
}

#endif
