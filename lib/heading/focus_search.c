#include "heading/focus_search.h"

#include <string.h>

#include "heading/flow_field.h"

#define TURN_STEP_Q28 INT32_C(1405520) /* 0.3 degrees */
#define TURN_STEPS 5
#define FOCUS_LIMIT_Q12 INT32_C(2048) /* a focus more than 26.6 degrees off the axis is none of a forward camera */
#define BANDS 8u

/* The tournament: all hypotheses before the first voters, a part of them before more, few before all. */
#define FIRST_VOTERS 8u
#define SECOND_VOTERS 24u
#define SECOND_PART 3u
#define LAST_PART 10u

static unsigned smaller(unsigned a, unsigned b) {
    return (a < b) ? a : b;
}

/* Width of a step of the score across the flow, a quarter of a pixel. px_q22 <= 83 886 (2^16.4): q15 <= 163. */
static int32_t band_q15(const roadpose_lens_t *lens) {
    const int32_t q15 = lens->px_q22 >> 9;
    return (q15 < 1) ? 1 : q15;
}

/* |d| <= 1/2 plus at most 10 * 1/20 of the vehicle's rotation: q15 clamped to 2^15. A step of the search: (1 + x^2) / 190
 * and xy / 190, below 1/38: q18 < 2^13. */
static void take_voter(roadpose_voters_t *voters, unsigned i, const roadpose_flow_t *flow, const int32_t *turn_q28) {
    static const int32_t STEP_Q28[3] = {0, TURN_STEP_Q28, 0};
    const roadpose_turn_terms_t terms = roadpose_turn_terms(flow->mx_q16, flow->my_q16);
    int32_t turned[2];
    roadpose_turn_flow(&terms, turn_q28, turned);
    const int32_t dx_q15 = roadpose_floor_shift32(flow->dx_q22 - turned[0] + 64, 7);
    const int32_t dy_q15 = roadpose_floor_shift32(flow->dy_q22 - turned[1] + 64, 7);
    voters->dx_q15[i] = (int16_t)roadpose_clamp(dx_q15, -INT16_MAX, INT16_MAX);
    voters->dy_q15[i] = (int16_t)roadpose_clamp(dy_q15, -INT16_MAX, INT16_MAX);
    roadpose_turn_flow(&terms, STEP_Q28, turned);
    voters->turn_u_q18[i] = (int16_t)roadpose_floor_shift32(turned[0], 4);
    voters->turn_v_q18[i] = (int16_t)roadpose_floor_shift32(turned[1], 4);
    voters->mx_q12[i] = (int16_t)roadpose_floor_shift32(flow->mx_q16 + 8, 4);
    voters->my_q12[i] = (int16_t)roadpose_floor_shift32(flow->my_q16 + 8, 4);
}

/* Evenly spread ones, and in an order of which every beginning is spread as well: 37 is odd, and 37 / 64 near the golden
 * section. */
void roadpose_voters_choose(roadpose_heading_t *instance, const int32_t *turn_q24) {
    const int32_t turn_q28[3] = {turn_q24[0] * 16, turn_q24[1] * 16, turn_q24[2] * 16};
    roadpose_voters_t *voters = &instance->voters;
    const unsigned moving = instance->flows_moving;
    const unsigned places = (moving > ROADPOSE_MAX_VOTERS) ? moving : ROADPOSE_MAX_VOTERS;
    voters->count = 0;
    for (unsigned i = 0; i < ROADPOSE_MAX_VOTERS; i++) {
        const unsigned place = (i * 37u % ROADPOSE_MAX_VOTERS) * places / ROADPOSE_MAX_VOTERS;
        if (place < moving) {
            take_voter(voters, voters->count, &instance->flow[place], turn_q28);
            voters->count++;
        }
    }
}

/* A voter's flow with some steps of rotation taken out: 5 steps of 2^13 are below 2^15.4 in q18, so q15 stays below
 * 2^15.4. */
typedef struct {
    int32_t x_q15;
    int32_t y_q15;
} step_t;

static step_t unturned(const roadpose_voters_t *v, unsigned i, int32_t steps) {
    return (step_t){v->dx_q15[i] - roadpose_floor_shift32(steps * v->turn_u_q18[i], 3),
                    v->dy_q15[i] - roadpose_floor_shift32(steps * v->turn_v_q18[i], 3)};
}

/* numerator / denominator, |quotient| <= FOCUS_LIMIT or false. |numerator| < 2^46, 0 < |denominator| < 2^32. Brought to a
 * denominator below 2^19, which leaves it 15 bits: a quotient is off by an eighth at most, and the numerator is below 2^31. */
static bool divide(int64_t numerator, int64_t denominator, int16_t *quotient) {
    uint64_t n = (uint64_t)roadpose_abs(numerator);
    uint64_t d = (uint64_t)roadpose_abs(denominator);
    if (n > d * FOCUS_LIMIT_Q12) {
        return false;
    }
    while (d >= UINT32_C(1) << 19) {
        d >>= 4;
        n >>= 4;
    }
    const int32_t q = (int32_t)((uint32_t)n / (uint32_t)d);
    *quotient = (int16_t)(((numerator < 0) != (denominator < 0)) ? -q : q);
    return true;
}

/* Intersection of two voters' lines, F x a = m_a x a and F x b = m_b x b; false where they are near parallel or meet far
 * outside. |m| <= 2^13, |d| < 2^15.4: each line's product < 2^29.4, determinant < 2^31.8, numerators < 2^45.8. */
static bool intersect(const roadpose_voters_t *v, unsigned i, unsigned j, roadpose_hypothesis_t *h) {
    const step_t a = unturned(v, i, h->steps);
    const step_t b = unturned(v, j, h->steps);
    const int64_t det_q30 = (int64_t)a.x_q15 * b.y_q15 - (int64_t)a.y_q15 * b.x_q15;
    const int64_t lengths_q30 = (int64_t)roadpose_length(a.x_q15, a.y_q15) * roadpose_length(b.x_q15, b.y_q15);
    if (roadpose_abs(det_q30) * 16 < lengths_q30 || det_q30 == 0) {
        return false;
    }
    const int32_t line_a_q27 = v->mx_q12[i] * a.y_q15 - v->my_q12[i] * a.x_q15;
    const int32_t line_b_q27 = v->mx_q12[j] * b.y_q15 - v->my_q12[j] * b.x_q15;
    return divide((int64_t)line_b_q27 * a.x_q15 - (int64_t)line_a_q27 * b.x_q15, det_q30, &h->fx_q12) &&
           divide((int64_t)line_b_q27 * a.y_q15 - (int64_t)line_a_q27 * b.y_q15, det_q30, &h->fy_q12);
}

/* Points for a hypothesis from the voters first...end - 1 that stream away from it: 4, 3, 2 or 1 for missing it by less than
 * 1, 2, 4 or 8 bands. A tight fit scores high, so that a loose crowd cannot outvote it.
 * |m| <= 2^13 + 2^11 < 2^13.4, |d| < 2^15.4: cross and inner product < 2^29.8. r is the length to 7 %, below
 * 1.4 * 2^13.4 < 2^14; a band 163 * r < 2^22. */
static uint32_t points_of(const roadpose_voters_t *v, const roadpose_hypothesis_t *h, unsigned first, unsigned end,
                          uint32_t narrow_q15) {
    static const uint8_t POINTS[BANDS] = {4, 3, 2, 2, 1, 1, 1, 1};
    uint32_t sum = 0;
    for (unsigned i = first; i < end; i++) {
        const step_t d = unturned(v, i, h->steps);
        const int32_t mx = v->mx_q12[i] - h->fx_q12;
        const int32_t my = v->my_q12[i] - h->fy_q12;
        const int32_t cross = mx * d.y_q15 - my * d.x_q15;
        if (mx * d.x_q15 + my * d.y_q15 <= 0) {
            continue;
        }
        const uint32_t off = (uint32_t)((cross < 0) ? -cross : cross);
        const uint32_t r = (uint32_t)roadpose_length(mx, my);
        const uint32_t bands = off / (narrow_q15 * r); /* r > 0: the inner product is */
        sum += (bands < BANDS) ? POINTS[bands] : 0;
    }
    return sum;
}

/* Adds the voters first...end - 1 to the score of each hypothesis. */
static void hear(roadpose_heading_t *instance, unsigned count, unsigned first, unsigned end) {
    const roadpose_voters_t *v = &instance->voters;
    const uint32_t narrow_q15 = (uint32_t)band_q15(&instance->lens);
    for (unsigned i = 0; i < count; i++) {
        roadpose_hypothesis_t *h = &instance->hypothesis[i];
        h->points = (uint16_t)(h->points + points_of(v, h, smaller(first, v->count), smaller(end, v->count), narrow_q15));
    }
}

/* Moves the `kept` best of `count` hypotheses to the front, earlier ones first where they are equal; points < 128, two to a
 * bin. */
static unsigned keep_best(roadpose_heading_t *instance, unsigned count, unsigned kept) {
    uint16_t *bins = instance->round.bins;
    unsigned level = ROADPOSE_NOISE_BINS;
    unsigned above = 0;
    if (count <= kept) {
        return count;
    }
    memset(bins, 0, sizeof instance->round.bins);
    for (unsigned i = 0; i < count; i++) {
        bins[instance->hypothesis[i].points / 2u]++;
    }
    do {
        level--;
        above += bins[level];
    } while (above < kept);
    unsigned equal = kept - (above - bins[level]); /* so many of this level */
    unsigned to = 0;
    for (unsigned i = 0; i < count; i++) {
        const roadpose_hypothesis_t h = instance->hypothesis[i];
        const unsigned bin = h.points / 2u;
        if (bin < level || (bin == level && equal == 0)) {
            continue;
        }
        equal -= (bin == level) ? 1u : 0u;
        instance->hypothesis[to] = h;
        to++;
    }
    return to;
}

/* The winner of the tournament. */
static const roadpose_hypothesis_t *best_of(roadpose_heading_t *instance, unsigned count) {
    const roadpose_hypothesis_t *best = &instance->hypothesis[0];
    const unsigned second = count / SECOND_PART + 1u;
    const unsigned last = count / LAST_PART + 1u;
    hear(instance, count, 0, FIRST_VOTERS);
    count = keep_best(instance, count, second);
    hear(instance, count, FIRST_VOTERS, SECOND_VOTERS);
    count = keep_best(instance, count, last);
    hear(instance, count, SECOND_VOTERS, ROADPOSE_MAX_VOTERS);
    for (unsigned i = 1; i < count; i++) {
        if (instance->hypothesis[i].points > best->points) {
            best = &instance->hypothesis[i];
        }
    }
    return best;
}

/* Adds the intersections of some pairs of voters under one rotation to the `count` hypotheses. */
static unsigned draw(roadpose_heading_t *instance, int32_t steps, unsigned pairs, uint32_t *random, unsigned count) {
    const roadpose_voters_t *v = &instance->voters;
    for (unsigned pair = 0; pair < pairs && count < ROADPOSE_MAX_HYPOTHESES; pair++) {
        roadpose_hypothesis_t *h = &instance->hypothesis[count];
        const unsigned i = roadpose_lcg_below(random, v->count);
        const unsigned j = roadpose_lcg_below(random, v->count);
        h->steps = (int16_t)steps;
        h->points = 0;
        count += intersect(v, i, j, h) ? 1u : 0u;
    }
    return count;
}

static uint32_t put(const roadpose_hypothesis_t *h, roadpose_expansion_t *motion) {
    motion->focus_q24[0] = h->fx_q12 * 4096;
    motion->focus_q24[1] = h->fy_q12 * 4096;
    motion->turn_q24[1] += h->steps * (TURN_STEP_Q28 / 16);
    return h->points;
}

uint32_t roadpose_focus_search(roadpose_heading_t *instance, unsigned pairs, uint32_t *random,
                               roadpose_expansion_t *best) {
    const unsigned count = (instance->voters.count == 0) ? 0 : draw(instance, 0, pairs, random, 0);
    return (count == 0) ? 0 : put(best_of(instance, count), best);
}

uint32_t roadpose_focus_search_turning(roadpose_heading_t *instance, unsigned pairs, uint32_t *random,
                                       roadpose_expansion_t *best) {
    unsigned count = 0;
    for (int32_t steps = 1; steps <= TURN_STEPS && instance->voters.count != 0; steps++) {
        count = draw(instance, steps, pairs, random, count);
        count = draw(instance, -steps, pairs, random, count);
    }
    return (count == 0) ? 0 : put(best_of(instance, count), best);
}
