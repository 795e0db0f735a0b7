/* From raw samples to disparities in Q8 pixels. */
#ifndef ROADPOSE_DECODER_H
#define ROADPOSE_DECODER_H

#include "roadpose/state.h"

/* Prepares *decoder for a format. Returns false, with *decoder unchanged, when a field is out of range. */
bool roadpose_decoder_prepare(roadpose_decoder_t *decoder, const roadpose_disparity_format_t *format);

/* Decodes every ROADPOSE_COLUMN_STEP-th sample of pixel row `row` into out_q8[columns]; 0 means no match.
 * frame->confidence is used where it is not NULL. */
void roadpose_decode_row(const roadpose_decoder_t *decoder, const roadpose_frame_t *frame, uint32_t row,
                         int16_t columns, uint16_t *out_q8);

#endif
