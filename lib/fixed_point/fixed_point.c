#include "fixed_point/fixed_point.h"

int64_t roadpose_scale(int64_t x, int bits) {
    return roadpose_floor_shift(x, (unsigned)-bits);
}

uint32_t roadpose_sqrt(uint64_t x) {
    uint64_t root = 0;
    uint64_t rest = x;
    /* One result bit a round. Invariant: (root >> shift)^2 <= x, and root + bit <= 2^63 fits. */
    for (uint64_t bit = UINT64_C(1) << 62; bit != 0; bit >>= 2) {
        if (rest >= root + bit) {
            rest -= root + bit;
            root = (root >> 1) + bit;
        } else {
            root >>= 1;
        }
    }
    return (uint32_t)root;
}

static uint64_t magnitude(int64_t x) {
    return (x < 0) ? (UINT64_C(0) - (uint64_t)x) : (uint64_t)x;
}

int64_t roadpose_ratio(int64_t numerator, int64_t denominator, unsigned bits) {
    const uint64_t n = magnitude(numerator);
    const uint64_t d = magnitude(denominator);
    const bool negative = (numerator < 0) != (denominator < 0);
    if (n == 0) {
        return 0;
    }
    if (d == 0) {
        return negative ? -ROADPOSE_RATIO_MAX : ROADPOSE_RATIO_MAX;
    }
    uint64_t quotient = n / d;
    uint64_t rest = n % d;
    for (unsigned i = 0; i < bits; i++) {
        if (quotient > ((uint64_t)ROADPOSE_RATIO_MAX >> 1)) {
            quotient = (uint64_t)ROADPOSE_RATIO_MAX;
            break;
        }
        rest <<= 1; /* rest < d < 2^62, so 2 rest fits */
        quotient <<= 1;
        if (rest >= d) {
            rest -= d;
            quotient |= 1u;
        }
    }
    if (quotient > (uint64_t)ROADPOSE_RATIO_MAX) {
        quotient = (uint64_t)ROADPOSE_RATIO_MAX; /* a numerator beyond 2^62 over 1 */
    }
    return negative ? -(int64_t)quotient : (int64_t)quotient;
}

unsigned roadpose_excess_bits(int64_t x, unsigned bits) {
    unsigned shift = 0;
    while ((x >> shift) >= (INT64_C(1) << bits)) {
        shift++;
    }
    return shift;
}
