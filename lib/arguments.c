#include "arguments.h"

#define SIDE_MIN_PX 64

static bool in_range(int32_t x, int32_t low, int32_t high) {
    return x >= low && x <= high;
}

/* 0 switches a limit off. */
static bool off_or_in_range(int32_t x, int32_t low, int32_t high) {
    return x == 0 || in_range(x, low, high);
}

void roadpose_settings_default(roadpose_settings_t *settings) {
    if (settings == NULL) {
        return;
    }
    *settings = (roadpose_settings_t){
        .method = 2,
        .refine = true,
        .points_percent = 100,
        .seed = 1,
        .corridor_half_width_mm = 2000,
        .corridor_range_mm = 25000,
        .obstacle_height_mm = 400,
        .noise_millipx = 600,
        .unevenness_mm = 50,
        .pitch_min_urad = -174533,
        .pitch_max_urad = 261799,
        .roll_max_urad = 436332,
        .height_min_um = 300000,
        .height_max_um = 4000000,
        .points_min = 96,
        .support_min_permille = 500,
        .range_min_mm = 5000,
    };
}

roadpose_result_t roadpose_check_rig(const roadpose_rig_t *rig) {
    if (rig->width_px > ROADPOSE_MAX_WIDTH || rig->height_px > ROADPOSE_MAX_HEIGHT) {
        return ROADPOSE_ERROR_SIZE;
    }
    const bool size = rig->width_px >= SIDE_MIN_PX && rig->height_px >= SIDE_MIN_PX;
    const bool camera = in_range(rig->focal_millipx, 50000, 4000000) &&
                        in_range(rig->cu_millipx, 0, (rig->width_px - 1) * 1000) &&
                        in_range(rig->cv_millipx, 0, (rig->height_px - 1) * 1000);
    const bool baseline = in_range(rig->baseline_um, 20000, 2000000);
    return (size && camera && baseline) ? ROADPOSE_OK : ROADPOSE_ERROR_RIG;
}

static bool limits_fit(const roadpose_settings_t *s) {
    const bool pitch = s->pitch_min_urad >= -523599 && s->pitch_min_urad <= s->pitch_max_urad &&
                       s->pitch_max_urad <= 523599;
    const bool roll = in_range(s->roll_max_urad, 0, 610865);
    const bool height = s->height_min_um >= 200000 && s->height_min_um <= s->height_max_um &&
                        s->height_max_um <= 5000000;
    return pitch && roll && height;
}

roadpose_result_t roadpose_check_settings(const roadpose_settings_t *s) {
    const bool method = (s->method == 1u || s->method == 2u) && in_range(s->points_percent, 1, 100);
    const bool corridor = off_or_in_range(s->corridor_half_width_mm, 500, 100000) &&
                          off_or_in_range(s->corridor_range_mm, 5000, 500000);
    const bool road = off_or_in_range(s->obstacle_height_mm, 100, 5000) && in_range(s->noise_millipx, 100, 3000) &&
                      in_range(s->unevenness_mm, 0, 200);
    const bool support = in_range(s->points_min, 16, ROADPOSE_MAX_POINTS) && s->support_min_permille <= 1000u &&
                         in_range(s->range_min_mm, 0, 50000);
    return (method && corridor && road && support && limits_fit(s)) ? ROADPOSE_OK : ROADPOSE_ERROR_SETTINGS;
}

roadpose_result_t roadpose_check_frame(const roadpose_t *instance, const roadpose_frame_t *frame) {
    const bool confidence_missing = instance->has_confidence_image && frame->confidence == NULL;
    if (frame->samples == NULL || confidence_missing) {
        return ROADPOSE_ERROR_NULL;
    }
    if (frame->width_px != instance->width_px || frame->height_px != instance->height_px) {
        return ROADPOSE_ERROR_SIZE;
    }
    const uint32_t row_bytes = 2u * (uint32_t)frame->width_px;
    const bool confidence_fits = !instance->has_confidence_image || frame->confidence_stride_bytes >= row_bytes;
    return (frame->stride_bytes >= row_bytes && confidence_fits) ? ROADPOSE_OK : ROADPOSE_ERROR_STRIDE;
}
