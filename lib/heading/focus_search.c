#include "heading/focus_search.h"

#include "heading/flow_field.h"

#define TURN_STEP_Q24 INT32_C(87845) /* 0.3 degrees */
#define TURN_STEPS 5
#define FOCUS_LIMIT_Q12 INT32_C(2048) /* a focus more than 26.6 degrees off the axis is none of a forward camera */
#define BANDS 4
#define BLOCK 16u

#if ROADPOSE_MAX_VOTERS % 16 != 0
#error "roadpose: ROADPOSE_MAX_VOTERS must be a multiple of 16"
#endif

/* Half widths of the bands across the flow: 1/4, 1/2, 1, 2 px. A tight fit scores in all four, so a loose crowd cannot
 * outvote it. */
typedef struct {
    int16_t q15[BANDS];
} bands_t;

/* px_q22 <= 83 886 (2^16.4): 2 px in q15 <= 1311. */
static bands_t bands_of(const roadpose_lens_t *lens) {
    bands_t bands;
    for (unsigned i = 0; i < BANDS; i++) {
        const int32_t q15 = (lens->px_q22 << i) >> 9;
        bands.q15[i] = (int16_t)((q15 < 1) ? 1 : q15);
    }
    return bands;
}

void roadpose_voters_choose(roadpose_heading_t *instance) {
    roadpose_voters_t *voters = &instance->voters;
    const unsigned moving = instance->flows_moving;
    voters->count = (uint16_t)((moving > ROADPOSE_MAX_VOTERS) ? ROADPOSE_MAX_VOTERS : moving);
    for (unsigned i = 0; i < voters->count; i++) {
        voters->flow[i] = (uint16_t)(i * moving / voters->count); /* <= 64 * 512 */
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
    for (unsigned i = voters->count; i % BLOCK != 0; i++) {
        voters->mx_q12[i] = 0;
        voters->my_q12[i] = 0;
        voters->dx_q15[i] = 0;
        voters->dy_q15[i] = 0;
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
 * loop has a fixed length and 16-bit factors so that compilers can do several voters at a time; voters beyond the last
 * have no flow and never score.
 * |m| <= 2^13 + 2^11 < 2^13.4, |d| < 2^15: cross and inner product < 2 * 2^28.4 < 2^30; length < 1.4 * 2^13.4 < 2^14,
 * band <= 1311: < 2^25. */
static int32_t score_block(const roadpose_voters_t *v, unsigned first, const int32_t *focus_q12, const bands_t *bands) {
    int32_t sum = 0;
    for (unsigned i = first; i < first + BLOCK; i++) {
        const int16_t mx = (int16_t)(v->mx_q12[i] - focus_q12[0]);
        const int16_t my = (int16_t)(v->my_q12[i] - focus_q12[1]);
        const int32_t cross = (int32_t)mx * v->dy_q15[i] - (int32_t)my * v->dx_q15[i];
        const int32_t inner = (int32_t)mx * v->dx_q15[i] + (int32_t)my * v->dy_q15[i];
        const int32_t off = (cross < 0) ? -cross : cross;
        const int16_t r = (int16_t)roadpose_length(mx, my);
        const int32_t hits = (off <= (int32_t)bands->q15[0] * r) + (off <= (int32_t)bands->q15[1] * r) +
                             (off <= (int32_t)bands->q15[2] * r) + (off <= (int32_t)bands->q15[3] * r);
        sum += (inner > 0) ? hits : 0;
    }
    return sum;
}

/* Score of a focus; given up, with 0, once its share of the voters seen lies below 1/2, 3/4, 5/6... of that of the best.
 * Scores <= 4 * 64, times 64 times 8: below 2^18. */
static uint32_t score(const roadpose_voters_t *v, const int32_t *focus_q12, const bands_t *bands, uint32_t best) {
    uint32_t sum = 0;
    for (unsigned first = 0; first < v->count; first += BLOCK) {
        sum += (uint32_t)score_block(v, first, focus_q12, bands);
        const unsigned blocks = first / BLOCK + 1u;
        if (sum * v->count * 2u * blocks < best * (first + BLOCK) * (2u * blocks - 1u)) {
            return 0;
        }
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
        const uint32_t points = score(&instance->voters, focus_q12, &bands, best_score);
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
