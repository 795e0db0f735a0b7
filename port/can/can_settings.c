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

/* The enumeration may be wider than the byte that a profile is kept in. */
static bool is_profile(roadpose_e2e_profile_t profile) {
    return (profile == ROADPOSE_E2E_PROFILE_1) || (profile == ROADPOSE_E2E_PROFILE_2) ||
           (profile == ROADPOSE_E2E_PROFILE_5);
}

bool roadpose_can_settings_default(roadpose_can_settings_t *settings, roadpose_e2e_profile_t profile) {
    if ((settings == NULL) || !is_profile(profile)) {
        return false;
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

/* Two messages with one data identifier could be taken for each other, and no checksum would tell. Profile 2 uses the
 * list's entry of the counter, the others data_id. Messages of different profiles differ by their checksums. */
static bool data_ids_differ(const roadpose_e2e_config_t *one, const roadpose_e2e_config_t *other) {
    if ((one->profile != other->profile) || (one->profile != (uint8_t)ROADPOSE_E2E_PROFILE_2)) {
        return (one->profile != other->profile) || (one->data_id != other->data_id);
    }
    bool differ = true;
    for (unsigned counter = 0; counter < ROADPOSE_E2E_LIST_ENTRIES; counter++) {
        differ = differ && (one->data_id_list[counter] != other->data_id_list[counter]);
    }
    return differ;
}

bool roadpose_can_settings_valid(const roadpose_can_settings_t *settings) {
    if (settings == NULL) {
        return false;
    }
    bool valid = (settings->cycle_us >= 1000u) && (settings->cycle_us <= 10000000u) &&
                 (settings->max_age_us <= 600000000u) && (settings->timeout_cycles >= 1u);
    for (unsigned message = 0; message < ROADPOSE_CAN_MESSAGES; message++) {
        unsigned next = (message + 1u) % ROADPOSE_CAN_MESSAGES;
        valid = valid && id_valid(settings->id[message]) && (settings->id[message] != settings->id[next]) &&
                roadpose_e2e_config_valid(&settings->e2e[message]) &&
                data_ids_differ(&settings->e2e[message], &settings->e2e[next]);
    }
    return valid;
}
