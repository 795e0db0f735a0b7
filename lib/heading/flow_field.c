#include "heading/flow_field.h"

#include <string.h>

void roadpose_lens_prepare(roadpose_lens_t *lens, const roadpose_rig_t *rig) {
    const int64_t focal = rig->focal_millipx;
    /* 2^24 / 256 * 1000 = 65536000 < 2^26; in q20 < 2^46; >= 50 000 divides it to < 2^31 */
    lens->k_q20 = (int32_t)((INT64_C(65536000) << 20) / focal);
    lens->px_q22 = (int32_t)((INT64_C(1000) << 22) / focal); /* 1048...83886 */
    lens->cu_q8 = (int32_t)(((int64_t)rig->cu_millipx * 256 + 500) / 1000);
    lens->cv_q8 = (int32_t)(((int64_t)rig->cv_millipx * 256 + 500) / 1000);
    lens->u_max_q8 = (rig->width_px - 1) * 256;
    lens->v_max_q8 = (rig->height_px - 1) * 256;
    lens->focal_millipx = rig->focal_millipx;
}

/* |offset| < 2^20 (2048 px in q8, and a principal point within), k < 2^31: below 2^51. */
static int64_t angle_q24(const roadpose_lens_t *lens, int32_t offset_q8) {
    return roadpose_floor_shift((int64_t)offset_q8 * lens->k_q20, 20);
}

static bool in_image(const roadpose_lens_t *lens, int32_t u_q8, int32_t v_q8) {
    return u_q8 >= 0 && u_q8 <= lens->u_max_q8 && v_q8 >= 0 && v_q8 <= lens->v_max_q8;
}

static bool within(int64_t x, int64_t limit) {
    return x >= -limit && x <= limit;
}

/* q24 ends to q16 middle and q22 step. */
static bool flow_of_axis(int64_t x0, int64_t x1, int32_t *middle_q16, int32_t *step_q22) {
    if (!within(x0, ROADPOSE_FLOW_REACH_Q24) || !within(x1, ROADPOSE_FLOW_REACH_Q24) ||
        !within(x1 - x0, ROADPOSE_FLOW_LENGTH_Q24)) {
        return false;
    }
    *middle_q16 = (int32_t)roadpose_floor_shift(x0 + x1, 9);
    *step_q22 = (int32_t)roadpose_floor_shift(x1 - x0, 2);
    return true;
}

static bool flow_of_track(const roadpose_lens_t *lens, const roadpose_track_t *track, roadpose_flow_t *flow) {
    if (!in_image(lens, track->u0_q8, track->v0_q8) || !in_image(lens, track->u1_q8, track->v1_q8)) {
        return false;
    }
    return flow_of_axis(angle_q24(lens, track->u0_q8 - lens->cu_q8), angle_q24(lens, track->u1_q8 - lens->cu_q8),
                        &flow->mx_q16, &flow->dx_q22) &&
           flow_of_axis(angle_q24(lens, track->v0_q8 - lens->cv_q8), angle_q24(lens, track->v1_q8 - lens->cv_q8),
                        &flow->my_q16, &flow->dy_q22);
}

/* Shortest length of a moving flow. */
static int32_t moving_min_q22(const roadpose_heading_t *instance) {
    /* <= 20 000 * 83 886 < 2^31 in 64 bits */
    return (int32_t)((int64_t)instance->settings.moving_min_millipx * instance->lens.px_q22 / 1000);
}

static size_t usable_tracks(const roadpose_lens_t *lens, const roadpose_track_t *tracks, size_t count) {
    size_t usable = 0;
    roadpose_flow_t flow;
    for (size_t i = 0; i < count; i++) {
        usable += flow_of_track(lens, &tracks[i], &flow) ? 1u : 0u;
    }
    return usable;
}

static uint32_t count_32(size_t count) {
    return (count > UINT32_MAX) ? UINT32_MAX : (uint32_t)count;
}

/* Moving flows from the front, the others from the back of the `kept` places. */
static void place(roadpose_heading_t *instance, const roadpose_flow_t *flow, size_t kept, int32_t moving_q22) {
    if (roadpose_length(flow->dx_q22, flow->dy_q22) >= moving_q22) {
        instance->flow[instance->flows_moving] = *flow;
        instance->flows_moving++;
    } else {
        instance->flow[kept - 1u - (size_t)(instance->flows - instance->flows_moving)] = *flow;
    }
    instance->flows++;
}

/* Keeps `kept` of `usable` tracks, evenly: an error term as in Bresenham's line, 0 <= error < usable + kept. */
static void keep_evenly(roadpose_heading_t *instance, const roadpose_track_t *tracks, size_t count, size_t usable,
                        size_t kept) {
    const int32_t moving_q22 = moving_min_q22(instance);
    size_t error = 0;
    roadpose_flow_t flow;
    for (size_t i = 0; i < count && instance->flows < kept; i++) {
        if (!flow_of_track(&instance->lens, &tracks[i], &flow)) {
            continue;
        }
        error += kept;
        if (error >= usable) {
            error -= usable;
            place(instance, &flow, kept, moving_q22);
        }
    }
}

void roadpose_flow_take(roadpose_heading_t *instance, const roadpose_track_t *tracks, size_t count,
                        roadpose_yaw_t *yaw) {
    /* Few tracks are all kept: only of many must it be known beforehand how many are usable. */
    const size_t usable = (count > ROADPOSE_MAX_TRACKS) ? usable_tracks(&instance->lens, tracks, count) : count;
    const size_t kept = (usable > ROADPOSE_MAX_TRACKS) ? ROADPOSE_MAX_TRACKS : usable;
    instance->flows = 0;
    instance->flows_moving = 0;
    keep_evenly(instance, tracks, count, usable, kept);
    const size_t still = (size_t)(instance->flows - instance->flows_moving);
    memmove(&instance->flow[instance->flows_moving], &instance->flow[kept - still], still * sizeof instance->flow[0]);
    yaw->tracks_used = instance->flows;
    yaw->tracks_moving = instance->flows_moving;
    yaw->dropped_limit = count_32(usable - kept);
    yaw->dropped_outside = count_32(count - (usable - kept) - instance->flows);
}
