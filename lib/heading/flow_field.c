#include "heading/flow_field.h"

#include <string.h>

/* What of 0...last lies within `reach` of the centre. 0 <= centre <= last < 2^19, reach < 2^21. */
static void bounds(int32_t centre_q8, int32_t last_q8, int32_t reach_q8, int32_t *low_q8, int32_t *span_q8) {
    const int32_t low = centre_q8 - reach_q8;
    const int32_t high = centre_q8 + reach_q8;
    *low_q8 = (low > 0) ? low : 0;
    *span_q8 = ((high < last_q8) ? high : last_q8) - *low_q8;
}

void roadpose_lens_prepare(roadpose_lens_t *lens, const roadpose_rig_t *rig) {
    const int64_t focal = rig->focal_millipx;
    const int32_t focal_q8 = (int32_t)(focal * 256 / 1000);
    /* 2^24 / 256 * 1000 = 65536000 < 2^26; in q20 < 2^46; >= 50 000 divides it to < 2^31 */
    lens->k_q20 = (int32_t)((INT64_C(65536000) << 20) / focal);
    lens->px_q22 = (int32_t)((INT64_C(1000) << 22) / focal); /* 1048...83886 */
    lens->cu_q8 = (int32_t)(((int64_t)rig->cu_millipx * 256 + 500) / 1000);
    lens->cv_q8 = (int32_t)(((int64_t)rig->cv_millipx * 256 + 500) / 1000);
    bounds(lens->cu_q8, (rig->width_px - 1) * 256, focal_q8 * ROADPOSE_FLOW_REACH, &lens->u_low_q8, &lens->u_span_q8);
    bounds(lens->cv_q8, (rig->height_px - 1) * 256, focal_q8 * ROADPOSE_FLOW_REACH, &lens->v_low_q8, &lens->v_span_q8);
    lens->jump_q8 = focal_q8 / 2;
    lens->focal_millipx = rig->focal_millipx;
}

/* 0 <= x - low <= span, for any x: the difference wraps around to something larger than the span otherwise. */
static bool within(int32_t x, int32_t low, int32_t span) {
    return (uint32_t)x - (uint32_t)low <= (uint32_t)span;
}

static bool is_usable(const roadpose_lens_t *lens, const roadpose_track_t *t) {
    return within(t->u0_q8, lens->u_low_q8, lens->u_span_q8) && within(t->u1_q8, lens->u_low_q8, lens->u_span_q8) &&
           within(t->v0_q8, lens->v_low_q8, lens->v_span_q8) && within(t->v1_q8, lens->v_low_q8, lens->v_span_q8) &&
           within(t->u1_q8 - t->u0_q8, -lens->jump_q8, 2 * lens->jump_q8) &&
           within(t->v1_q8 - t->v0_q8, -lens->jump_q8, 2 * lens->jump_q8);
}

/* |sum| < 2^21, |step| < 2^20, k < 2^31: products below 2^52. */
static int32_t middle_q16(const roadpose_lens_t *lens, int32_t sum_q8) {
    return (int32_t)roadpose_floor_shift((int64_t)sum_q8 * lens->k_q20, 29);
}

static int32_t step_q22(const roadpose_lens_t *lens, int32_t step_q8) {
    return (int32_t)roadpose_floor_shift((int64_t)step_q8 * lens->k_q20, 22);
}

static void flow_of_track(const roadpose_lens_t *lens, const roadpose_track_t *t, roadpose_flow_t *flow) {
    flow->mx_q16 = middle_q16(lens, t->u0_q8 + t->u1_q8 - 2 * lens->cu_q8);
    flow->my_q16 = middle_q16(lens, t->v0_q8 + t->v1_q8 - 2 * lens->cv_q8);
    flow->dx_q22 = step_q22(lens, t->u1_q8 - t->u0_q8);
    flow->dy_q22 = step_q22(lens, t->v1_q8 - t->v0_q8);
}

/* Shortest length of a moving flow. */
static int32_t moving_min_q22(const roadpose_heading_t *instance) {
    /* <= 20 000 * 83 886 < 2^31 in 64 bits */
    return (int32_t)((int64_t)instance->settings.moving_min_millipx * instance->lens.px_q22 / 1000);
}

static size_t usable_tracks(const roadpose_lens_t *lens, const roadpose_track_t *tracks, size_t count) {
    size_t usable = 0;
    for (size_t i = 0; i < count; i++) {
        usable += is_usable(lens, &tracks[i]) ? 1u : 0u;
    }
    return usable;
}

static uint32_t count_32(size_t count) {
    return (count > UINT32_MAX) ? UINT32_MAX : (uint32_t)count;
}

/* Moving flows from the front, the others from the back of the `kept` places. */
static void place(roadpose_heading_t *instance, const roadpose_track_t *track, size_t kept, int32_t moving_q22) {
    roadpose_flow_t flow;
    flow_of_track(&instance->lens, track, &flow);
    if (roadpose_length(flow.dx_q22, flow.dy_q22) >= moving_q22) {
        instance->flow[instance->flows_moving] = flow;
        instance->flows_moving++;
    } else {
        instance->flow[kept - 1u - (size_t)(instance->flows - instance->flows_moving)] = flow;
    }
    instance->flows++;
}

/* Keeps `kept` of `usable` tracks, evenly: an error term as in Bresenham's line, 0 <= error < usable + kept. */
static void keep_evenly(roadpose_heading_t *instance, const roadpose_track_t *tracks, size_t count, size_t usable,
                        size_t kept) {
    const int32_t moving_q22 = moving_min_q22(instance);
    size_t error = 0;
    for (size_t i = 0; i < count && instance->flows < kept; i++) {
        if (!is_usable(&instance->lens, &tracks[i])) {
            continue;
        }
        error += kept;
        if (error >= usable) {
            error -= usable;
            place(instance, &tracks[i], kept, moving_q22);
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
