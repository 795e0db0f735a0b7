/* Fixed-point arithmetic on standard integers. No signed overflow, no shift of negative numbers. */
#ifndef ROADPOSE_FIXED_POINT_H
#define ROADPOSE_FIXED_POINT_H

#include <stdbool.h>
#include <stdint.h>

/* Largest and smallest quotient that roadpose_ratio() returns. */
#define ROADPOSE_RATIO_MAX INT64_C(0x3FFFFFFFFFFFFFFF)

/* floor(x / 2^bits) without shifting a negative number. bits <= 63. */
static inline int64_t roadpose_floor_shift(int64_t x, unsigned bits) {
    return (x >= 0) ? (x >> bits) : (-1 - ((-1 - x) >> bits));
}

static inline int32_t roadpose_floor_shift32(int32_t x, unsigned bits) {
    return (x >= 0) ? (x >> bits) : (-1 - ((-1 - x) >> bits));
}

static inline int64_t roadpose_abs(int64_t x) {
    return (x < 0) ? -x : x; /* callers keep |x| < 2^63 */
}

static inline int64_t roadpose_clamp(int64_t x, int64_t low, int64_t high) {
    return (x < low) ? low : ((x > high) ? high : x);
}

static inline int32_t roadpose_clamp32(int64_t x) {
    return (int32_t)roadpose_clamp(x, INT32_MIN, INT32_MAX);
}

/* floor(x * 2^bits); bits in -63...0. A call instead of inline code, for where speed is nothing and size something. */
int64_t roadpose_scale(int64_t x, int bits);

/* floor(sqrt(x)). 32 rounds, no division. */
uint32_t roadpose_sqrt(uint64_t x);

/* numerator / denominator * 2^bits, rounded towards zero, saturating at +-ROADPOSE_RATIO_MAX; 0 / 0 gives 0.
 * Any numerator, |denominator| < 2^62, bits <= 40. At most bits rounds of shift and subtract after one division. */
int64_t roadpose_ratio(int64_t numerator, int64_t denominator, unsigned bits);

/* How far x must be shifted right so that it fits into bits (1...62) bits. x >= 0. */
unsigned roadpose_excess_bits(int64_t x, unsigned bits);

/* Angle of the point (x, y) in micro-radians, -pi...pi, right to 1 urad for max(|x|, |y|) >= 2^24; 0 for (0, 0).
 * |x|, |y| <= 2^30. CORDIC (Volder 1959), 30 rounds of shift and add. */
int32_t roadpose_arctangent(int32_t y, int32_t x);

/* Linear congruential generator (Numerical Recipes' constants): next state. */
static inline uint32_t roadpose_lcg_next(uint32_t state) {
    return state * UINT32_C(1664525) + UINT32_C(1013904223);
}

/* Steps *state and gives a number in 0...count - 1, taken from the high bits, which are the good ones. count >= 1. */
static inline uint32_t roadpose_lcg_below(uint32_t *state, uint32_t count) {
    *state = roadpose_lcg_next(*state);
    return (uint32_t)(((uint64_t)*state * count) >> 32);
}

#endif
