/* Where a profile keeps its counter, and its checksum. Shared by the two sides of the protection. */
#ifndef ROADPOSE_E2E_LAYOUT_H
#define ROADPOSE_E2E_LAYOUT_H

#include "roadpose/e2e.h"

/* Largest counter of the profile: 14, 15, 255. An unknown profile: 0. */
uint8_t roadpose_e2e_counter_max(uint8_t profile);

/* The counter as it stands in the frame; for profile 1 it may be 15, which no sender sends. */
uint8_t roadpose_e2e_counter_of(uint8_t profile, const uint8_t data[8]);

/* The checksum over the frame as it stands and the data identifier; 8 bits for profiles 1 and 2. */
uint16_t roadpose_e2e_crc(const roadpose_e2e_config_t *config, const uint8_t data[8]);

/* The checksum that is written in the frame. */
uint16_t roadpose_e2e_crc_of(uint8_t profile, const uint8_t data[8]);

#endif
