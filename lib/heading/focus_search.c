#include "heading/focus_search.h"

#include "heading/flow_field.h"

#define TURN_STEP_Q24 INT32_C(73204) /* 0.25 degrees */
#define TURN_STEPS 6
#define FOCUS_LIMIT_Q12 INT32_C(2048) /* a focus more than 26.6 degrees off the axis is none of a forward camera */
#define BANDS 4

/* Half widths of the bands across the flow: 1/4, 1/2, 1, 2 px. A tight fit scores in all four, so a loose crowd cannot
 * outvote it. */
typedef struct {
    int32_t q15[BANDS];
} bands_t;

/* px_q22 <= 83 886 (2^16.4): 2 px in q15 <= 1311. */
static bands_t bands_of(const roadpose_lens_t *lens) {
    bands_t bands;
    for (unsigned i = 0; i < BANDS; i++) {
        const int32_t q15 = (lens->px_q22 << i) >> 9;
        bands.q15[i] = (q15 < 1) ? 1 : q15;
    }
    return bands;
}

void roadpose_voters_choose(roadpose_heading_t *instance) {
    roadpose_voters_t *voters = &instance->voters;
    const int32_t moving_q22 = roadpose_flow_moving_q22(instance);
    unsigned moving = 0;
    for (unsigned i = 0; i < instance->flows; i++) {
        moving += (roadpose_length(instance->flow[i].dx_q22, instance->flow[i].dy_q22) >= moving_q22) ? 1u : 0u;
    }
    const unsigned kept = (moving > ROADPOSE_MAX_VOTERS) ? ROADPOSE_MAX_VOTERS : moving;
    unsigned error = 0;
    voters->count = 0;
    for (unsigned i = 0; i < instance->flows && voters->count < kept; i++) {
        if (roadpose_length(instance->flow[i].dx_q22, instance->flow[i].dy_q22) < moving_q22) {
            continue;
        }
        error += kept;
        if (error >= moving) {
            error -= moving;
            voters->flow[voters->count] = (uint16_t)i;
            voters->count++;
        }
    }
}

/* Takes the rotation out of the voters' flow. |m| <= 2: q12 <= 2^13. |d| <= 1/2 plus at most 10 * 1/20 by a rotation
 * of at most 1/20: q15 < 2^15, clamped. */
static void voters_unturn(roadpose_heading_t *instance, const int32_t *turn_q24) {
    roadpose_voters_t *voters = &instance->voters;
    for (unsigned i = 0; i < voters->count; i++) {
        const roadpose_flow_t *flow = &instance->flow[voters->flow[i]];
        int32_t turned[2];
        roadpose_turn_flow(flow->mx_q16, flow->my_q16, turn_q24, turned);
        voters->mx_q12[i] = (int16_t)roadpose_floor_shift32(flow->mx_q16 + 8, 4);
        voters->my_q12[i] = (int16_t)roadpose_floor_shift32(flow->my_q16 + 8, 4);
        const int32_t dx_q15 = roadpose_floor_shift32(flow->dx_q22 - turned[0] + 64, 7);
        const int32_t dy_q15 = roadpose_floor_shift32(flow->dy_q22 - turned[1] + 64, 7);
        voters->dx_q15[i] = (int16_t)roadpose_clamp(dx_q15, -INT16_MAX, INT16_MAX);
        voters->dy_q15[i] = (int16_t)roadpose_clamp(dy_q15, -INT16_MAX, INT16_MAX);
    }
}

/* Intersection of two voters' lines; false where they are near parallel or meet far outside.
 * d q15 <= 2^15: D and the numerator < 2^31 in 64 bits; s clamped to 2^31 times 2^15: below 2^47. */
static bool intersect(const roadpose_voters_t *v, unsigned i, unsigned j, int32_t *focus_q12) {
    const int64_t ix = v->dx_q15[i];
    const int64_t iy = v->dy_q15[i];
    const int64_t det_q30 = ix * v->dy_q15[j] - iy * v->dx_q15[j];
    const int64_t lengths_q30 = (int64_t)roadpose_length(v->dx_q15[i], v->dy_q15[i]) *
                                roadpose_length(v->dx_q15[j], v->dy_q15[j]);
    if (roadpose_abs(det_q30) * 16 < lengths_q30 || det_q30 == 0) {
        return false;
    }
    const int64_t wx = v->mx_q12[j] - v->mx_q12[i];
    const int64_t wy = v->my_q12[j] - v->my_q12[i];
    const int64_t s_q16 = roadpose_clamp(roadpose_ratio(wx * v->dy_q15[j] - wy * v->dx_q15[j], det_q30, 19),
                                         -(INT64_C(1) << 31), INT64_C(1) << 31);
    const int64_t fx = v->mx_q12[i] + roadpose_floor_shift(s_q16 * ix, 19);
    const int64_t fy = v->my_q12[i] + roadpose_floor_shift(s_q16 * iy, 19);
    if (roadpose_abs(fx) > FOCUS_LIMIT_Q12 || roadpose_abs(fy) > FOCUS_LIMIT_Q12) {
        return false;
    }
    focus_q12[0] = (int32_t)fx;
    focus_q12[1] = (int32_t)fy;
    return true;
}

/* For each voter that streams away from the focus, the number of bands in which it misses it.
 * |m| <= 2^13 + 2^11 < 2^13.4, |d| < 2^15: cross and inner product < 2 * 2^28.4 < 2^30; band * length <= 1311 * 2^14.4
 * < 2^25. */
static uint32_t score(const roadpose_voters_t *v, const int32_t *focus_q12, const bands_t *bands) {
    uint32_t sum = 0;
    for (unsigned i = 0; i < v->count; i++) {
        const int32_t mx = v->mx_q12[i] - focus_q12[0];
        const int32_t my = v->my_q12[i] - focus_q12[1];
        const int32_t cross = mx * v->dy_q15[i] - my * v->dx_q15[i];
        const int32_t off = (cross < 0) ? -cross : cross;
        const int32_t r = roadpose_length(mx, my);
        const uint32_t hits = (uint32_t)(off <= bands->q15[0] * r) + (uint32_t)(off <= bands->q15[1] * r) +
                              (uint32_t)(off <= bands->q15[2] * r) + (uint32_t)(off <= bands->q15[3] * r);
        sum += (mx * v->dx_q15[i] + my * v->dy_q15[i] > 0) ? hits : 0u;
    }
    return sum;
}

static uint32_t search(roadpose_heading_t *instance, const int32_t *turn_q24, unsigned hypotheses, uint32_t *random,
                       uint32_t best_score, roadpose_expansion_t *best) {
    const bands_t bands = bands_of(&instance->lens);
    voters_unturn(instance, turn_q24);
    const int32_t turn[3] = {turn_q24[0], turn_q24[1], turn_q24[2]};
    for (unsigned h = 0; h < hypotheses; h++) {
        int32_t focus_q12[2];
        const unsigned i = roadpose_lcg_below(random, instance->voters.count);
        const unsigned j = roadpose_lcg_below(random, instance->voters.count);
        if (!intersect(&instance->voters, i, j, focus_q12)) {
            continue;
        }
        const uint32_t points = score(&instance->voters, focus_q12, &bands);
        if (points > best_score) {
            best_score = points;
            *best = (roadpose_expansion_t){{focus_q12[0] * 4096, focus_q12[1] * 4096}, {turn[0], turn[1], turn[2]}};
        }
    }
    return best_score;
}

uint32_t roadpose_focus_search(roadpose_heading_t *instance, unsigned hypotheses, uint32_t *random,
                               roadpose_expansion_t *best) {
    if (instance->voters.count == 0) {
        return 0;
    }
    return search(instance, best->turn_q24, hypotheses, random, 0, best);
}

uint32_t roadpose_focus_search_turning(roadpose_heading_t *instance, unsigned hypotheses, uint32_t *random,
                                       roadpose_expansion_t *best) {
    const int32_t base[3] = {best->turn_q24[0], best->turn_q24[1], best->turn_q24[2]};
    uint32_t best_score = 0;
    if (instance->voters.count == 0) {
        return 0;
    }
    for (int32_t step = -TURN_STEPS; step <= TURN_STEPS; step++) {
        const int32_t turn[3] = {base[0], base[1] + step * TURN_STEP_Q24, base[2]};
        if (step != 0) {
            best_score = search(instance, turn, hypotheses, random, best_score, best);
        }
    }
    return best_score;
}
