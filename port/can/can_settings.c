#include "roadpose/can.h"

#include <stddef.h>

#define FIRST_IDENTIFIER UINT32_C(0x3D0)
#define FIRST_DATA_ID 0x5250u /* "RP" */

/* Profile 2 wants a list for each message such that no two messages share an entry at the same counter. 251 is prime,
 * and AUTOSAR's largest entry is 250: (counter + 1) * factor modulo 251 differs for different factors. */
static void fill_list(uint8_t list[ROADPOSE_E2E_LIST_ENTRIES], unsigned message) {
    static const uint8_t factors[ROADPOSE_CAN_MESSAGES] = {83, 97, 113};
    for (unsigned counter = 0; counter < ROADPOSE_E2E_LIST_ENTRIES; counter++) {
        list[counter] = (uint8_t)(((counter + 1u) * factors[message]) % 251u);
    }
}

bool roadpose_can_settings_default(roadpose_can_settings_t *settings, roadpose_e2e_profile_t profile) {
    if ((settings == NULL) || (roadpose_e2e_next_counter((uint8_t)profile, 0u) == 0u)) {
        return false; /* a profile whose counter does not move is not one */
    }
    for (unsigned message = 0; message < ROADPOSE_CAN_MESSAGES; message++) {
        settings->id[message] = FIRST_IDENTIFIER + message;
        settings->e2e[message].profile = (uint8_t)profile;
        settings->e2e[message].max_delta = 3u;
        settings->e2e[message].data_id = (uint16_t)(FIRST_DATA_ID + message);
        fill_list(settings->e2e[message].data_id_list, message);
    }
    settings->cycle_us = 100000u;
    settings->max_age_us = 250000u;
    settings->timeout_cycles = 3u;
    return true;
}

static bool id_valid(uint32_t id) {
    bool extended = (id & ROADPOSE_CAN_EXTENDED) != 0u;
    uint32_t mask = extended ? (ROADPOSE_CAN_EXTENDED | ROADPOSE_CAN_EXTENDED_MASK) : ROADPOSE_CAN_STANDARD_MASK;
    return (id & ~mask) == 0u;
}

bool roadpose_can_settings_valid(const roadpose_can_settings_t *settings) {
    if (settings == NULL) {
        return false;
    }
    bool valid = (settings->cycle_us >= 1000u) && (settings->cycle_us <= 10000000u) &&
                 (settings->max_age_us <= 600000000u) && (settings->timeout_cycles >= 1u);
    for (unsigned message = 0; message < ROADPOSE_CAN_MESSAGES; message++) {
        uint32_t next_id = settings->id[(message + 1u) % ROADPOSE_CAN_MESSAGES];
        valid = valid && id_valid(settings->id[message]) && (settings->id[message] != next_id) &&
                roadpose_e2e_config_valid(&settings->e2e[message]);
    }
    return valid;
}
