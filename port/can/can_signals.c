#include "can_signals.h"

#define HEADER_BITS 24u /* the E2E header */

uint32_t roadpose_can_invalid(const roadpose_can_place_t *place) {
    return (UINT32_C(1) << place->bits) - 1u;
}

/* Range: |urad| is clamped to 2^20 (60 deg, beyond every code), codes_per_urad_q46 < 2^40, so the product is below
 * 2^60; zero * 2^46 < 2^59: the sum is below 2^61, and it is shifted only when it is not negative. An angle never lies
 * exactly between two codes, because a step in micro-radians is irrational. It may come as near as 1e-7 of a code: the
 * rounding of the constant makes less than 2^-27, and the host test finds the nearest code for every micro-radian. */
uint32_t roadpose_can_angle_code(const roadpose_can_angle_t *signal, bool valid, int32_t urad) {
    int64_t angle = (urad > INT32_C(0x100000)) ? INT32_C(0x100000) : urad;
    angle = (angle < -INT32_C(0x100000)) ? -INT32_C(0x100000) : angle;
    int64_t scaled = angle * signal->codes_per_urad_q46 + signal->zero * (INT64_C(1) << 46) + (INT64_C(1) << 45);
    int64_t code = (scaled < 0) ? -1 : (scaled >> 46);
    bool fits = valid && (code >= 0) && (code <= signal->place.last);
    return fits ? (uint32_t)code : roadpose_can_invalid(&signal->place);
}

/* Half a step is added before the division: the nearest code, upwards on a tie. value is a 32-bit number, so nothing
 * comes near the ends of 64 bits. */
uint32_t roadpose_can_linear_code(const roadpose_can_linear_t *signal, bool valid, int64_t value) {
    int64_t above = value - signal->offset + (signal->step / 2);
    int64_t code = (above < 0) ? -1 : (above / signal->step);
    bool fits = valid && (code >= 0) && (code <= signal->place.last);
    return fits ? (uint32_t)code : roadpose_can_invalid(&signal->place);
}

/* Modulo the invalid code, which thereby never occurs. */
uint32_t roadpose_can_count_code(const roadpose_can_place_t *place, bool valid, uint32_t count) {
    uint32_t invalid = roadpose_can_invalid(place);
    return valid ? (count % invalid) : invalid;
}

/* Range: |code - zero| < 2^14, urad_per_code_q32 < 2^41: below 2^55. Half away from zero, on the magnitude. */
bool roadpose_can_angle_value(const roadpose_can_angle_t *signal, uint32_t code, int32_t *value) {
    bool valid = code <= signal->place.last;
    bool negative = code < signal->zero;
    uint32_t steps = negative ? (signal->zero - code) : (code - signal->zero);
    int32_t magnitude = (int32_t)((steps * signal->urad_per_code_q32 + (INT64_C(1) << 31)) >> 32);
    *value = valid ? (negative ? -magnitude : magnitude) : 0;
    return valid;
}

bool roadpose_can_linear_value(const roadpose_can_linear_t *signal, uint32_t code, int32_t *value) {
    bool valid = code <= signal->place.last;
    *value = valid ? (signal->offset + (int32_t)code * signal->step) : 0;
    return valid;
}

bool roadpose_can_count_value(const roadpose_can_place_t *place, uint32_t code, uint32_t *value) {
    bool valid = code <= place->last;
    *value = valid ? code : 0u;
    return valid;
}

uint64_t roadpose_can_place(const roadpose_can_place_t *place, uint32_t code) {
    return (uint64_t)code << (place->start - HEADER_BITS);
}

static uint64_t read_signals(const uint8_t data[8]) {
    uint64_t signals = 0;
    for (unsigned i = 8u; i > 3u; i--) {
        signals = (signals << 8) | data[i - 1u];
    }
    return signals;
}

uint32_t roadpose_can_take(const roadpose_can_place_t *place, const uint8_t data[8]) {
    return (uint32_t)(read_signals(data) >> (place->start - HEADER_BITS)) & roadpose_can_invalid(place);
}

void roadpose_can_write(uint64_t signals, uint8_t data[8]) {
    for (unsigned i = 0; i < 3u; i++) {
        data[i] = 0;
    }
    for (unsigned i = 3u; i < 8u; i++) {
        data[i] = (uint8_t)((signals >> (8u * (i - 3u))) & 0xFFu);
    }
}
