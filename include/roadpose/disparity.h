/* roadpose: how a stereo engine delivers disparity.
 *
 * A frame is a borrowed view of the engine's own buffer: 16-bit samples in rows. The format says which bits of a
 * sample are the disparity, which are confidence, and which samples mean "no match". The library never writes to
 * the buffer and never keeps a pointer to it after the frame is finished.
 */
#ifndef ROADPOSE_DISPARITY_H
#define ROADPOSE_DISPARITY_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum {
    ROADPOSE_BYTES_NATIVE = 0, /* as the processor that runs the library stores a uint16_t */
    ROADPOSE_BYTES_LITTLE = 1,
    ROADPOSE_BYTES_BIG = 2
} roadpose_byte_order_t;

/* Layout of one 16-bit sample. From a raw sample s (after byte order):
 *   no match, when  is_signed and bit 15 is set, or
 *                   has_invalid and invalid_first <= s <= invalid_last (s as unsigned), or
 *                   the confidence is below confidence_min, or
 *                   the disparity, offset included, is not in (0, ROADPOSE_MAX_DISPARITY);
 *   disparity      = ((s >> value_shift) mod 2^value_bits) / 2^fraction_bits  pixels, plus offset_millipx / 1000.
 * Confidence comes from the sample itself (confidence_bits > 0: (s >> confidence_shift) mod 2^confidence_bits), or
 * from a second image (has_confidence_image: roadpose_frame_t.confidence), or not at all. */
typedef struct {
    uint8_t byte_order;        /* roadpose_byte_order_t */
    bool is_signed;            /* bit 15 is a sign; a negative disparity is no match */
    uint8_t value_shift;       /* bits below the disparity field, 0...15 */
    uint8_t value_bits;        /* width of the disparity field, fraction included, 1...16; with value_shift <= 16 */
    uint8_t fraction_bits;     /* fraction bits of the disparity field, 0...15 and <= value_bits */
    bool has_invalid;          /* invalid_first...invalid_last mean "no match" */
    uint16_t invalid_first;    /* raw sample, unsigned */
    uint16_t invalid_last;     /* raw sample, unsigned, >= invalid_first */
    uint8_t confidence_shift;  /* with confidence_bits <= 16 */
    uint8_t confidence_bits;   /* 0: no confidence in the sample; else 1...15 */
    bool has_confidence_image; /* confidence is a second 16-bit image, same byte order; not with confidence_bits */
    uint16_t confidence_min;   /* smallest confidence that counts as a match */
    int32_t offset_millipx;    /* added to every disparity: corrects a known matcher bias; -16 000...+16 000 */
} roadpose_disparity_format_t;

/* Named presets. Each fills all fields of *format for the layout of a known source; change single fields after it. */
typedef enum {
    ROADPOSE_FORMAT_U16_Q8 = 0, /* KITTI, DSEC, Argoverse: unsigned, 8 fraction bits, 0 = no match */
    ROADPOSE_FORMAT_OPENCV = 1, /* StereoBM, StereoSGBM: signed, 4 fraction bits, negative = no match */
    ROADPOSE_FORMAT_VPI = 2,    /* NVIDIA VPI: signed Q10.5, confidence image, threshold 32767 */
    ROADPOSE_FORMAT_TI_SDE = 3, /* TI DMPAC SDE: [15] sign, [14:3] disparity Q8.4, [2:0] confidence; bit 15 set = no match;
                                   threshold 1 */
    ROADPOSE_FORMAT_LIBSGM = 4, /* libSGM with sub-pixel: unsigned, 4 fraction bits, 0xFFFF = no match */
    ROADPOSE_FORMAT_TRICLOPS = 5 /* FLIR Triclops: unsigned 8.8 big-endian, top byte 255 = no match */
} roadpose_format_preset_t;

/* Fills *format from a preset. Returns false, with *format unchanged, on a null pointer or an unknown preset.
 * Re-entrant; constant time. */
bool roadpose_format_preset(roadpose_disparity_format_t *format, roadpose_format_preset_t preset);

/* A borrowed frame. The buffers belong to the caller and must not change until the frame is finished (processed,
 * or cancelled). No alignment is asked of them. */
typedef struct {
    const void *samples;     /* first row, first column */
    uint32_t stride_bytes;   /* from one row to the next, >= 2 * width_px */
    uint16_t width_px;       /* must equal the rig's */
    uint16_t height_px;      /* must equal the rig's */
    const void *confidence;  /* second image, same width and height; NULL unless has_confidence_image */
    uint32_t confidence_stride_bytes; /* >= 2 * width_px where confidence is given */
} roadpose_frame_t;

#ifdef __cplusplus
}
#endif

#endif
