#include "roadpose/heading.h"

#include <string.h>

#include "heading/flow_field.h"
#include "heading/heading.h"
#include "heading/running_yaw.h"
#include "heading/yaw_angle.h"

#define READY_MARK UINT32_C(0x59415731)
#define SIDE_MIN_PX 64
#define NO_MOTION_INTERVAL_US 100000

void roadpose_heading_settings_default(roadpose_heading_settings_t *settings) {
    if (settings == NULL) {
        return;
    }
    *settings = (roadpose_heading_settings_t){
        .seed = 1,
        .tracks_min = 12,
        .share_min_permille = 350,
        .moving_min_millipx = 2000,
        .noise_max_millipx = 1000,
        .speed_min_mm_s = 3000,
        .yaw_rate_max_urad_s = 61087,
        .rate_sigma_max_urad_s = 13090,
        .sigma_max_urad = 4363,
        .yaw_max_urad = 104720,
    };
}

static bool in_range(int32_t x, int32_t low, int32_t high) {
    return x >= low && x <= high;
}

static bool settings_fit(const roadpose_heading_settings_t *s) {
    const bool tracks = in_range(s->tracks_min, 8, ROADPOSE_MAX_TRACKS) && in_range(s->share_min_permille, 100, 1000) &&
                        in_range(s->moving_min_millipx, 500, 20000) && in_range(s->noise_max_millipx, 100, 5000);
    const bool motion = in_range(s->speed_min_mm_s, 0, 50000) && in_range(s->yaw_rate_max_urad_s, 1000, 1000000) &&
                        in_range(s->rate_sigma_max_urad_s, 1000, 1000000);
    return tracks && motion && in_range(s->sigma_max_urad, 100, 100000) && in_range(s->yaw_max_urad, 0, 400000);
}

static roadpose_result_t check_rig(const roadpose_rig_t *rig) {
    if (rig->width_px > ROADPOSE_MAX_WIDTH || rig->height_px > ROADPOSE_MAX_HEIGHT) {
        return ROADPOSE_ERROR_SIZE;
    }
    const bool fits = rig->width_px >= SIDE_MIN_PX && rig->height_px >= SIDE_MIN_PX &&
                      in_range(rig->focal_millipx, 50000, 4000000) &&
                      in_range(rig->cu_millipx, 0, (rig->width_px - 1) * 1000) &&
                      in_range(rig->cv_millipx, 0, (rig->height_px - 1) * 1000);
    return fits ? ROADPOSE_OK : ROADPOSE_ERROR_RIG;
}

roadpose_result_t roadpose_heading_init(roadpose_heading_t *instance, const roadpose_rig_t *rig,
                                        const roadpose_heading_settings_t *settings) {
    roadpose_heading_settings_t chosen;
    if (instance == NULL || rig == NULL) {
        return ROADPOSE_ERROR_NULL;
    }
    const roadpose_result_t result = check_rig(rig);
    if (result != ROADPOSE_OK) {
        return result;
    }
    roadpose_heading_settings_default(&chosen);
    if (settings != NULL) {
        chosen = *settings;
    }
    if (!settings_fit(&chosen)) {
        return ROADPOSE_ERROR_SETTINGS;
    }
    memset(instance, 0, sizeof *instance);
    instance->settings = chosen;
    roadpose_lens_prepare(&instance->lens, rig);
    instance->ready = READY_MARK;
    return ROADPOSE_OK;
}

/* Copies what the vehicle says, or says nothing for it. */
static roadpose_motion_t motion_or_none(const roadpose_motion_t *motion) {
    const roadpose_motion_t none = {.interval_us = NO_MOTION_INTERVAL_US};
    return (motion != NULL) ? *motion : none;
}

roadpose_result_t roadpose_heading_process(roadpose_heading_t *instance, const roadpose_track_t *tracks, size_t count,
                                           const roadpose_motion_t *motion, const int32_t *normal_q30,
                                           roadpose_yaw_t *yaw) {
    if (instance == NULL || yaw == NULL || (tracks == NULL && count != 0)) {
        return ROADPOSE_ERROR_NULL;
    }
    if (instance->ready != READY_MARK) {
        return ROADPOSE_ERROR_ORDER;
    }
    const roadpose_motion_t known = motion_or_none(motion);
    if (!in_range(known.interval_us, 1000, 10000000) || (normal_q30 != NULL && !roadpose_is_unit(normal_q30))) {
        return ROADPOSE_ERROR_SETTINGS;
    }
    memset(yaw, 0, sizeof *yaw);
    roadpose_flow_take(instance, tracks, count, yaw);
    roadpose_heading_estimate(instance, &known, normal_q30, yaw);
    roadpose_running_add(instance, yaw);
    return ROADPOSE_OK;
}

roadpose_result_t roadpose_heading_running(const roadpose_heading_t *instance, roadpose_running_yaw_t *running) {
    if (instance == NULL || running == NULL) {
        return ROADPOSE_ERROR_NULL;
    }
    if (instance->ready != READY_MARK) {
        return ROADPOSE_ERROR_ORDER;
    }
    *running = instance->running;
    return ROADPOSE_OK;
}

roadpose_result_t roadpose_heading_restart(roadpose_heading_t *instance) {
    if (instance == NULL) {
        return ROADPOSE_ERROR_NULL;
    }
    if (instance->ready != READY_MARK) {
        return ROADPOSE_ERROR_ORDER;
    }
    roadpose_running_clear(instance);
    return ROADPOSE_OK;
}

size_t roadpose_heading_state_bytes(void) {
    return sizeof(roadpose_heading_t);
}

const char *roadpose_yaw_status_word(uint8_t status) {
    static const char *const WORDS[ROADPOSE_YAW_STATUS_COUNT] = {
        "ok", "slow", "turning", "few_tracks", "standing", "no_focus", "noisy", "ambiguous", "uncertain", "no_road",
        "outside_limits"};
    return (status < ROADPOSE_YAW_STATUS_COUNT) ? WORDS[status] : "unknown";
}
