/* The 40 bits of signals of a message: one integer, its lowest bit is bit 0 of byte 3. Shift and mask only: a bit-field
 * or a packed struct would depend on the compiler and on the byte order. */
#ifndef ROADPOSE_CAN_SIGNALS_H
#define ROADPOSE_CAN_SIGNALS_H

#include <stdbool.h>
#include <stdint.h>

/* A place in the frame, and the codes it takes. bits <= 14. All ones is the invalid code. */
typedef struct {
    uint8_t start; /* bit in the frame as the DBC counts it, 24...63 */
    uint8_t bits;  /* 4...14 */
    uint16_t last; /* largest valid code, below all ones */
} roadpose_can_place_t;

/* physical = (code - zero) * step, step in micro-radians, given twice so that neither direction divides. */
typedef struct {
    roadpose_can_place_t place;
    uint16_t zero;              /* code of angle 0 */
    int64_t codes_per_urad_q46; /* 2^46 / step, rounded */
    int64_t urad_per_code_q32;  /* 2^32 * step, rounded */
} roadpose_can_angle_t;

/* physical = offset + code * step, in the integer unit of the field. */
typedef struct {
    roadpose_can_place_t place;
    int32_t offset;
    int32_t step;
} roadpose_can_linear_t;

uint32_t roadpose_can_invalid(const roadpose_can_place_t *place);

/* The nearest code, or the invalid code where the value does not fit or is not valid. */
uint32_t roadpose_can_angle_code(const roadpose_can_angle_t *signal, bool valid, int32_t urad);
uint32_t roadpose_can_linear_code(const roadpose_can_linear_t *signal, bool valid, int64_t value);
uint32_t roadpose_can_count_code(const roadpose_can_place_t *place, bool valid, uint32_t count);

/* False, with *value = 0, for a code beyond the last valid one. */
bool roadpose_can_angle_value(const roadpose_can_angle_t *signal, uint32_t code, int32_t *value);
bool roadpose_can_linear_value(const roadpose_can_linear_t *signal, uint32_t code, int32_t *value);
bool roadpose_can_count_value(const roadpose_can_place_t *place, uint32_t code, uint32_t *value);

/* The frame's signals. */
uint64_t roadpose_can_place(const roadpose_can_place_t *place, uint32_t code);
uint32_t roadpose_can_take(const roadpose_can_place_t *place, const uint8_t data[8]);
void roadpose_can_write(uint64_t signals, uint8_t data[8]);

#endif
