#include "heading/normal_equations.h"

#include "fixed_point/fixed_point.h"

#define KEPT_BITS 33
#define Z_LIMIT (INT64_C(1) << 35) /* room for growth in the elimination */
#define L_LIMIT (INT64_C(1) << 27)
#define PIVOT_SHARE 14

/* Shift, even, that brings every diagonal entry and right-hand side below 2^33. */
static unsigned shift_of(const roadpose_sums_t *sums, unsigned unknowns) {
    int64_t largest = 0;
    for (unsigned i = 0; i < unknowns; i++) {
        const int64_t g = roadpose_abs(sums->g[i]);
        largest = (sums->h[roadpose_entry(i, i)] > largest) ? sums->h[roadpose_entry(i, i)] : largest;
        largest = (g > largest) ? g : largest;
    }
    const unsigned shift = roadpose_excess_bits(largest, KEPT_BITS);
    return shift + (shift & 1u);
}

/* One column of the decomposition. Below and right of it, l holds the remaining Schur complement h: |h| <= 2^33
 * (positive definite, so no entry exceeds the largest diagonal): 2^53 in q20; |L h| <= 2^27 * 2^33, |L z| <= 2^62. */
static bool eliminate(roadpose_factors_t *f, unsigned column, int64_t pivot_min) {
    const int64_t pivot = f->l[column][column];
    if (pivot <= pivot_min) {
        return false;
    }
    f->d[column] = pivot;
    for (unsigned i = f->unknowns - 1u; i > column; i--) {
        const int64_t ratio = roadpose_clamp(f->l[i][column] * (INT64_C(1) << 20) / pivot, -L_LIMIT, L_LIMIT);
        for (unsigned k = column + 1; k <= i; k++) { /* rows above i still hold h in this column */
            const int64_t part = roadpose_floor_shift(ratio * f->l[k][column], 20);
            f->l[i][k] = roadpose_clamp(f->l[i][k] - part, -(INT64_C(1) << KEPT_BITS), INT64_C(1) << KEPT_BITS);
        }
        const int64_t part = roadpose_floor_shift(ratio * f->z[column], 20);
        f->z[i] = roadpose_clamp(f->z[i] - part, -Z_LIMIT, Z_LIMIT);
        f->l[i][column] = ratio;
    }
    return true;
}

bool roadpose_factorise(const roadpose_sums_t *sums, unsigned unknowns, roadpose_factors_t *factors) {
    const unsigned shift = shift_of(sums, unknowns);
    factors->unknowns = unknowns;
    factors->half_shift = shift / 2;
    for (unsigned i = 0; i < unknowns; i++) {
        for (unsigned k = 0; k <= i; k++) {
            factors->l[i][k] = roadpose_floor_shift(sums->h[roadpose_entry(i, k)], shift);
        }
        factors->z[i] = roadpose_floor_shift(sums->g[i], shift);
    }
    bool told = true;
    for (unsigned column = 0; told && column < unknowns; column++) {
        told = eliminate(factors, column, roadpose_floor_shift(sums->h[roadpose_entry(column, column)], shift + PIVOT_SHARE));
    }
    return told;
}

/* L^T x = y, from the last unknown up. |L| <= 2^27, |x| <= 2^28: products below 2^55, sums of four below 2^57. */
void roadpose_solve(const roadpose_factors_t *factors, int32_t *x_q28) {
    for (unsigned i = factors->unknowns; i-- > 0;) {
        int64_t x = factors->z[i] * (INT64_C(1) << 22) / factors->d[i]; /* q46 / q40, 22 more bits: q28; < 2^57 */
        x = roadpose_clamp(x, -(INT64_C(1) << 40), INT64_C(1) << 40);
        for (unsigned k = i + 1; k < factors->unknowns; k++) {
            x -= roadpose_floor_shift(factors->l[k][i] * x_q28[k], 20);
        }
        x_q28[i] = (int32_t)roadpose_clamp(x, -(INT32_C(1) << 28), INT32_C(1) << 28);
    }
}

void roadpose_follow(const roadpose_factors_t *factors, const int32_t *turn_q28, int32_t *focus_q28) {
    for (unsigned i = ROADPOSE_UNKNOWNS_FOCUS; i-- > 0;) {
        int64_t x = 0;
        for (unsigned k = i + 1; k < ROADPOSE_UNKNOWNS_FOCUS; k++) {
            x -= roadpose_floor_shift(factors->l[k][i] * focus_q28[k], 20);
        }
        for (unsigned k = 0; k < ROADPOSE_UNKNOWNS_MOTION - ROADPOSE_UNKNOWNS_FOCUS; k++) {
            x -= roadpose_floor_shift(factors->l[ROADPOSE_UNKNOWNS_FOCUS + k][i] * turn_q28[k], 20);
        }
        focus_q28[i] = (int32_t)roadpose_clamp(x, -(INT32_C(1) << 28), INT32_C(1) << 28);
    }
}

/* y = L^-1 c; variance = sum of y^2 / D. y clamped to 2^30, so y^2 <= 2^60; D >= 1; each ratio (q16) clamped to 2^59.
 * noise <= 2^18, root < 2^31.5: product below 2^50. Scale: y is q16, D is q40 less the shift, the ratio adds 16 bits:
 * root = sqrt(variance) * 2^(16 - 20 + half_shift + 8). */
int32_t roadpose_deviation(const roadpose_factors_t *factors, unsigned unknowns, const int32_t *c_q16,
                           int32_t noise_q22) {
    int64_t y[ROADPOSE_UNKNOWNS_MOTION];
    int64_t sum = 0;
    for (unsigned i = 0; i < unknowns; i++) {
        y[i] = c_q16[i];
        for (unsigned k = 0; k < i; k++) {
            y[i] -= roadpose_floor_shift(factors->l[i][k] * y[k], 20);
        }
        y[i] = roadpose_clamp(y[i], -(INT64_C(1) << 30), INT64_C(1) << 30);
        sum += roadpose_clamp(roadpose_ratio(y[i] * y[i], factors->d[i], 16), 0, INT64_C(1) << 59);
    }
    const int64_t root = roadpose_sqrt((uint64_t)sum);
    return roadpose_clamp32(roadpose_floor_shift(noise_q22 * root, 4 + factors->half_shift));
}

/* With t = D^(1/2) L^T turn on the three turn unknowns: sum of t^2 / noise^2. |turn| <= 2^27, L <= 2^27: below 2^54 + ...,
 * after the shift clamped to 2^30; root of D < 2^17: below 2^47. turn q28, root q20 less half_shift, noise q22:
 * t / noise = q26 less half_shift; kept in q4, clamped to 2^20 so that the sum of squares (q8) is below 2^42. */
int64_t roadpose_turn_significance(const roadpose_factors_t *factors, const int32_t *turn_q28, int32_t noise_q22) {
    const unsigned first = ROADPOSE_UNKNOWNS_FOCUS;
    int64_t sum = 0;
    for (unsigned i = first; i < ROADPOSE_UNKNOWNS_MOTION; i++) {
        int64_t t = turn_q28[i - first];
        for (unsigned k = i + 1; k < ROADPOSE_UNKNOWNS_MOTION; k++) {
            t += roadpose_floor_shift(factors->l[k][i] * turn_q28[k - first], 20);
        }
        t = roadpose_clamp(roadpose_abs(t), 0, INT64_C(1) << 30);
        const int64_t scaled = t * (int64_t)roadpose_sqrt((uint64_t)factors->d[i]) / noise_q22;
        const int64_t deviations_q4 = roadpose_clamp(roadpose_floor_shift(scaled, 22 - factors->half_shift), 0, 1 << 20);
        sum += deviations_q4 * deviations_q4;
    }
    return roadpose_clamp(sum, 0, INT64_C(1) << 40);
}
