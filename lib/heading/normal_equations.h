/* Weighted least squares in up to five unknowns: sums, factors, solution, and what the factors tell of its spread.
 *
 * Unknowns, in this order: focus column and row, rotation about x (nodding), z (rolling) and y (yawing). One row of the
 * problem is j . x = e: j in q16, e in q22, weight in q8, |j| <= 2^20, |e| <= 2^19. The focus enters as a sixteenth of
 * itself, which brings its column to the size of the others. */
#ifndef ROADPOSE_HEADING_NORMAL_EQUATIONS_H
#define ROADPOSE_HEADING_NORMAL_EQUATIONS_H

#include "roadpose/heading.h"

#define ROADPOSE_UNKNOWNS_FOCUS 2u
#define ROADPOSE_UNKNOWNS_MOTION 5u

/* Place of an entry of the lower triangle, row >= column. */
static inline unsigned roadpose_entry(unsigned row, unsigned column) {
    return row * (row + 1u) / 2u + column;
}

static inline void roadpose_add_product(int64_t *sum, int32_t a, int32_t b) {
    *sum += (int64_t)a * b;
}

/* Adds one row. |weight j| <= 2^28, times j or e: <= 2^48; 512 rows: <= 2^57. Written out: this is what a fit spends its
 * time with. */
static inline void roadpose_sums_add_focus(roadpose_sums_t *sums, const int32_t *j_q16, int32_t e_q22,
                                           int32_t weight_q8) {
    const int32_t u = weight_q8 * j_q16[0];
    const int32_t v = weight_q8 * j_q16[1];
    roadpose_add_product(&sums->h[0], u, j_q16[0]);
    roadpose_add_product(&sums->h[1], v, j_q16[0]);
    roadpose_add_product(&sums->h[2], v, j_q16[1]);
    roadpose_add_product(&sums->g[0], u, e_q22);
    roadpose_add_product(&sums->g[1], v, e_q22);
}

static inline void roadpose_add_row(int64_t *h, int32_t wj, const int32_t *j_q16) {
    roadpose_add_product(&h[0], wj, j_q16[0]);
    roadpose_add_product(&h[1], wj, j_q16[1]);
    roadpose_add_product(&h[2], wj, j_q16[2]);
}

/* The rows of a rotation, of the same weight. */
static inline void roadpose_sums_add_turn(roadpose_sums_t *sums, const int32_t *j_q16, int32_t e_q22,
                                          int32_t weight_q8) {
    const int32_t x = weight_q8 * j_q16[2];
    const int32_t z = weight_q8 * j_q16[3];
    const int32_t y = weight_q8 * j_q16[4];
    roadpose_add_row(&sums->h[3], x, j_q16);
    roadpose_add_row(&sums->h[6], z, j_q16);
    roadpose_add_product(&sums->h[9], z, j_q16[3]);
    roadpose_add_row(&sums->h[10], y, j_q16);
    roadpose_add_product(&sums->h[13], y, j_q16[3]);
    roadpose_add_product(&sums->h[14], y, j_q16[4]);
    roadpose_add_product(&sums->g[2], x, e_q22);
    roadpose_add_product(&sums->g[3], z, e_q22);
    roadpose_add_product(&sums->g[4], y, e_q22);
}

/* H = L D L^T, scaled down by an even power of two, and z = L^-1 g. False where a pivot has less than 2^-14 of its
 * diagonal left: the rows do not tell the unknowns apart. */
bool roadpose_factorise(const roadpose_sums_t *sums, unsigned unknowns, roadpose_factors_t *factors);

/* Solution in q28, each component clamped to +-1. */
void roadpose_solve(const roadpose_factors_t *factors, int32_t *x_q28);

/* Change of the two focus unknowns that keeps them best when the rotation is changed by turn_q28 (x, z, y). */
void roadpose_follow(const roadpose_factors_t *factors, const int32_t *turn_q28, int32_t *focus_q28);

/* Standard deviation (q22) of c . x for rows of standard deviation noise_q22, with only the first `unknowns` unknowns
 * free. c in q16, |c| <= 2^20. */
int32_t roadpose_deviation(const roadpose_factors_t *factors, unsigned unknowns, const int32_t *c_q16,
                           int32_t noise_q22);

/* How far a rotation (x, z, y; q28, |turn| <= 1/2) is from none, with the focus free: squared in standard deviations,
 * q8, saturating at 2^40. Chi-square of three degrees of freedom when there is none. */
int64_t roadpose_turn_significance(const roadpose_factors_t *factors, const int32_t *turn_q28, int32_t noise_q22);

#endif
