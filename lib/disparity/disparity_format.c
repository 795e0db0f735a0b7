#include <stddef.h>

#include "roadpose/disparity.h"

static const roadpose_disparity_format_t PRESETS[] = {
    [ROADPOSE_FORMAT_U16_Q8] = {.value_bits = 16, .fraction_bits = 8, .has_invalid = true},
    [ROADPOSE_FORMAT_OPENCV] = {.is_signed = true, .value_bits = 15, .fraction_bits = 4},
    [ROADPOSE_FORMAT_VPI] =
        {.is_signed = true, .value_bits = 15, .fraction_bits = 5, .has_confidence_image = true, .confidence_min = 32767},
    [ROADPOSE_FORMAT_TI_SDE] = {.is_signed = true,
                                .value_shift = 3,
                                .value_bits = 12,
                                .fraction_bits = 4,
                                .confidence_bits = 3,
                                .confidence_min = 1},
    [ROADPOSE_FORMAT_LIBSGM] =
        {.value_bits = 16, .fraction_bits = 4, .has_invalid = true, .invalid_first = 0xFFFF, .invalid_last = 0xFFFF},
    [ROADPOSE_FORMAT_TRICLOPS] = {.byte_order = ROADPOSE_BYTES_BIG,
                                  .value_bits = 16,
                                  .fraction_bits = 8,
                                  .has_invalid = true,
                                  .invalid_first = 0xFF00,
                                  .invalid_last = 0xFFFF},
};

bool roadpose_format_preset(roadpose_disparity_format_t *format, roadpose_format_preset_t preset) {
    const size_t index = (size_t)preset;
    if (format == NULL || index >= sizeof PRESETS / sizeof PRESETS[0]) {
        return false;
    }
    *format = PRESETS[index];
    return true;
}
