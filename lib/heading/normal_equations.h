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

/* Adds one row to the first `unknowns` rows and columns. Sums of 512 rows: weight j < 2^28, times j or e: < 2^48; < 2^57. */
static inline void roadpose_sums_add(roadpose_sums_t *sums, unsigned unknowns, const int32_t *j_q16, int32_t e_q22,
                                     int32_t weight_q8) {
    for (unsigned row = 0; row < unknowns; row++) {
        const int64_t wj = (int64_t)weight_q8 * j_q16[row];
        for (unsigned column = 0; column <= row; column++) {
            sums->h[row][column] += wj * j_q16[column];
        }
        sums->g[row] += wj * e_q22;
    }
}

/* H = L D L^T, scaled down by an even power of two, and z = L^-1 g. False where a pivot has less than 2^-14 of its diagonal left: the rows do not tell the unknowns apart. */
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
