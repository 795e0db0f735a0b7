#include "heading/focus_search.h"

#include <string.h>

#include "heading/flow_field.h"

#define TURN_STEP_Q24 INT32_C(87845) /* 0.3 degrees */
#define TURN_STEPS 5
#define FOCUS_LIMIT_Q12 INT32_C(2048) /* a focus more than 26.6 degrees off the axis is none of a forward camera */
#define BLOCK 16u

#if ROADPOSE_MAX_VOTERS % 16 != 0
#error "roadpose: ROADPOSE_MAX_VOTERS must be a multiple of 16"
#endif

/* Half width of the narrowest of four bands across the flow, a quarter of a pixel; the others are twice as wide each. A
 * tight fit scores in all four, so a loose crowd cannot outvote it. px_q22 <= 83 886 (2^16.4): q15 <= 163. */
static int32_t band_q15(const roadpose_lens_t *lens) {
    const int32_t q15 = lens->px_q22 >> 9;
    return (q15 < 1) ? 1 : q15;
}

static void take_voter(roadpose_voters_t *voters, unsigned i, const roadpose_flow_t *flow, const int32_t *turn_q24) {
    const int32_t step[3] = {0, TURN_STEP_Q24, 0};
    int32_t turned[2];
    roadpose_turn_flow(flow->mx_q16, flow->my_q16, turn_q24, turned);
    voters->du_q22[i] = flow->dx_q22 - turned[0];
    voters->dv_q22[i] = flow->dy_q22 - turned[1];
    roadpose_turn_flow(flow->mx_q16, flow->my_q16, step, turned);
    voters->turn_u_q22[i] = turned[0];
    voters->turn_v_q22[i] = turned[1];
    voters->mx_q12[i] = (int16_t)roadpose_floor_shift32(flow->mx_q16 + 8, 4);
    voters->my_q12[i] = (int16_t)roadpose_floor_shift32(flow->my_q16 + 8, 4);
}

void roadpose_voters_choose(roadpose_heading_t *instance, const int32_t *turn_q24) {
    roadpose_voters_t *voters = &instance->voters;
    const unsigned moving = instance->flows_moving;
    memset(voters, 0, sizeof *voters);
    voters->count = (uint16_t)((moving > ROADPOSE_MAX_VOTERS) ? ROADPOSE_MAX_VOTERS : moving);
    for (unsigned i = 0; i < voters->count; i++) {
        take_voter(voters, i, &instance->flow[i * moving / voters->count], turn_q24); /* <= 64 * 512 */
    }
}

/* Takes `steps` steps of rotation out of the voters' flow. |d| <= 1/2 plus at most 10 * 1/20 of the vehicle's rotation,
 * and 5 steps of at most 5 * 1/190: q22 < 2^23 and so are the steps added up; q15 clamped to 2^15. */
static void voters_unturn(roadpose_voters_t *voters, int32_t steps) {
    for (unsigned i = 0; i < voters->count; i++) {
        const int32_t dx_q15 = roadpose_floor_shift32(voters->du_q22[i] - steps * voters->turn_u_q22[i] + 64, 7);
        const int32_t dy_q15 = roadpose_floor_shift32(voters->dv_q22[i] - steps * voters->turn_v_q22[i] + 64, 7);
        voters->dx_q15[i] = (int16_t)roadpose_clamp(dx_q15, -INT16_MAX, INT16_MAX);
        voters->dy_q15[i] = (int16_t)roadpose_clamp(dy_q15, -INT16_MAX, INT16_MAX);
    }
}

/* Intersection of two voters' lines; false where they are near parallel or meet far outside.
 * d q15 <= 2^15, w <= 2^14: D < 2^31, the numerator < 2^30, in q46 < 2^49; s clamped to 2^31 times 2^15: below 2^47. */
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
    const int64_t numerator_q27 = wx * v->dy_q15[j] - wy * v->dx_q15[j];
    const int64_t s_q16 = roadpose_clamp(numerator_q27 * (INT64_C(1) << 19) / det_q30, -(INT64_C(1) << 31),
                                         INT64_C(1) << 31);
    const int64_t fx = v->mx_q12[i] + roadpose_floor_shift(s_q16 * ix, 19);
    const int64_t fy = v->my_q12[i] + roadpose_floor_shift(s_q16 * iy, 19);
    if (roadpose_abs(fx) > FOCUS_LIMIT_Q12 || roadpose_abs(fy) > FOCUS_LIMIT_Q12) {
        return false;
    }
    focus_q12[0] = (int32_t)fx;
    focus_q12[1] = (int32_t)fy;
    return true;
}

/* Over one block of voters: for each that streams away from the focus, the number of bands in which it misses it. The
 * loop has a fixed length and no branch, so that compilers can do several voters at a time; voters beyond the last have
 * no flow and never score.
 * |m| <= 2^13 + 2^11 < 2^13.4, |d| < 2^15: cross and inner product < 2 * 2^28.4 < 2^30. r is the length to 7 %, below
 * 1.4 * 2^13.4 < 2^14; the widest band 8 * 163 * r < 2^25. */
static int32_t score_block(const roadpose_voters_t *v, unsigned first, const int32_t *focus_q12, int32_t narrow_q15) {
    int32_t sum = 0;
    for (unsigned i = first; i < first + BLOCK; i++) {
        const int32_t mx = v->mx_q12[i] - focus_q12[0];
        const int32_t my = v->my_q12[i] - focus_q12[1];
        const int32_t cross = mx * v->dy_q15[i] - my * v->dx_q15[i];
        const int32_t inner = mx * v->dx_q15[i] + my * v->dy_q15[i];
        const int32_t off = (cross < 0) ? -cross : cross;
        const int32_t ax = (mx < 0) ? -mx : mx;
        const int32_t ay = (my < 0) ? -my : my;
        const int32_t r = (ax > ay) ? ax + ay * 3 / 8 : ay + ax * 3 / 8;
        const int32_t band = narrow_q15 * r;
        const int32_t hits = (off <= band) + (off <= 2 * band) + (off <= 4 * band) + (off <= 8 * band);
        sum += (inner > 0) ? hits : 0;
    }
    return sum;
}

/* Score of a focus; given up, with 0, once its share of the voters seen lies below 1/2, 3/4, 5/6... of that of the best.
 * Scores <= 4 * 64, times 64 times 8: below 2^18. */
static uint32_t score(const roadpose_voters_t *v, const int32_t *focus_q12, int32_t narrow_q15, uint32_t best) {
    uint32_t sum = 0;
    for (unsigned first = 0; first < v->count; first += BLOCK) {
        sum += (uint32_t)score_block(v, first, focus_q12, narrow_q15);
        const unsigned blocks = first / BLOCK + 1u;
        if (sum * v->count * 2u * blocks < best * (first + BLOCK) * (2u * blocks - 1u)) {
            return 0;
        }
    }
    return sum;
}

/* Hypotheses under one rotation; *best changes only when one scores better than best_score. */
static uint32_t search(roadpose_heading_t *instance, int32_t steps, unsigned hypotheses, uint32_t *random,
                       uint32_t best_score, int32_t *best_q12) {
    const int32_t narrow_q15 = band_q15(&instance->lens);
    voters_unturn(&instance->voters, steps);
    for (unsigned h = 0; h < hypotheses; h++) {
        int32_t focus_q12[2];
        const unsigned i = roadpose_lcg_below(random, instance->voters.count);
        const unsigned j = roadpose_lcg_below(random, instance->voters.count);
        if (!intersect(&instance->voters, i, j, focus_q12)) {
            continue;
        }
        const uint32_t points = score(&instance->voters, focus_q12, narrow_q15, best_score);
        if (points > best_score) {
            best_score = points;
            best_q12[0] = focus_q12[0];
            best_q12[1] = focus_q12[1];
        }
    }
    return best_score;
}

static void put_focus(roadpose_expansion_t *motion, const int32_t *focus_q12) {
    motion->focus_q24[0] = focus_q12[0] * 4096;
    motion->focus_q24[1] = focus_q12[1] * 4096;
}

uint32_t roadpose_focus_search(roadpose_heading_t *instance, unsigned hypotheses, uint32_t *random,
                               roadpose_expansion_t *best) {
    int32_t focus_q12[2] = {0, 0};
    if (instance->voters.count == 0) {
        return 0;
    }
    const uint32_t points = search(instance, 0, hypotheses, random, 0, focus_q12);
    put_focus(best, focus_q12);
    return points;
}

uint32_t roadpose_focus_search_turning(roadpose_heading_t *instance, unsigned hypotheses, uint32_t *random,
                                       roadpose_expansion_t *best) {
    const int32_t base_q24 = best->turn_q24[1];
    int32_t focus_q12[2] = {0, 0};
    uint32_t best_score = 0;
    for (int32_t steps = -TURN_STEPS; steps <= TURN_STEPS && instance->voters.count != 0; steps++) {
        if (steps == 0) {
            continue;
        }
        const uint32_t points = search(instance, steps, hypotheses, random, best_score, focus_q12);
        if (points > best_score) {
            best_score = points;
            best->turn_q24[1] = base_q24 + steps * TURN_STEP_Q24;
        }
    }
    put_focus(best, focus_q12);
    return best_score;
}
