/* AUTOSAR E2E profiles 1, 2 and 5: checksums and the sender's side. */
#include "e2e_layout.h"

#include <stddef.h>

/* Bitwise: 9 bytes a frame are 72 rounds, and three tables would be 1 KiB of constants. */
static uint8_t crc8(uint8_t crc, uint8_t polynomial, uint8_t byte) {
    uint8_t value = (uint8_t)(crc ^ byte);
    for (unsigned bit = 0; bit < 8u; bit++) {
        uint8_t feedback = ((value & 0x80u) != 0u) ? polynomial : 0u;
        value = (uint8_t)(((unsigned)value << 1) ^ feedback);
    }
    return value;
}

static uint16_t crc16(uint16_t crc, uint8_t byte) {
    uint16_t value = (uint16_t)(crc ^ ((unsigned)byte << 8));
    for (unsigned bit = 0; bit < 8u; bit++) {
        uint16_t feedback = ((value & 0x8000u) != 0u) ? 0x1021u : 0u;
        value = (uint16_t)(((unsigned)value << 1) ^ feedback);
    }
    return value;
}

static uint16_t crc_profile_1(const roadpose_e2e_config_t *config, const uint8_t data[8]) {
    uint8_t crc = crc8(0x00u, 0x1Du, (uint8_t)(config->data_id & 0xFFu));
    crc = crc8(crc, 0x1Du, (uint8_t)(config->data_id >> 8));
    for (unsigned i = 1; i < ROADPOSE_E2E_BYTES; i++) {
        crc = crc8(crc, 0x1Du, data[i]);
    }
    return crc;
}

static uint16_t crc_profile_2(const roadpose_e2e_config_t *config, const uint8_t data[8]) {
    uint8_t crc = 0xFFu;
    for (unsigned i = 1; i < ROADPOSE_E2E_BYTES; i++) {
        crc = crc8(crc, 0x2Fu, data[i]);
    }
    crc = crc8(crc, 0x2Fu, config->data_id_list[data[1] & 0x0Fu]);
    return (uint16_t)(crc ^ 0xFFu);
}

static uint16_t crc_profile_5(const roadpose_e2e_config_t *config, const uint8_t data[8]) {
    uint16_t crc = 0xFFFFu;
    for (unsigned i = 2; i < ROADPOSE_E2E_BYTES; i++) {
        crc = crc16(crc, data[i]);
    }
    crc = crc16(crc, (uint8_t)(config->data_id & 0xFFu));
    return crc16(crc, (uint8_t)(config->data_id >> 8));
}

uint16_t roadpose_e2e_crc(const roadpose_e2e_config_t *config, const uint8_t data[8]) {
    uint16_t crc;
    switch (config->profile) {
    case ROADPOSE_E2E_PROFILE_1:
        crc = crc_profile_1(config, data);
        break;
    case ROADPOSE_E2E_PROFILE_2:
        crc = crc_profile_2(config, data);
        break;
    default:
        crc = crc_profile_5(config, data);
        break;
    }
    return crc;
}

uint16_t roadpose_e2e_crc_of(uint8_t profile, const uint8_t data[8]) {
    unsigned high = (profile == ROADPOSE_E2E_PROFILE_5) ? data[1] : 0u;
    return (uint16_t)(data[0] | (high << 8));
}

uint8_t roadpose_e2e_counter_of(uint8_t profile, const uint8_t data[8]) {
    return (profile == ROADPOSE_E2E_PROFILE_5) ? data[2] : (uint8_t)(data[1] & 0x0Fu);
}

uint8_t roadpose_e2e_counter_max(uint8_t profile) {
    uint8_t largest = 0;
    if (profile == ROADPOSE_E2E_PROFILE_1) {
        largest = 14u;
    } else if (profile == ROADPOSE_E2E_PROFILE_2) {
        largest = 15u;
    } else if (profile == ROADPOSE_E2E_PROFILE_5) {
        largest = 255u;
    } else {
        /* unknown: no counter but 0 */
    }
    return largest;
}

uint8_t roadpose_e2e_next_counter(uint8_t profile, uint8_t counter) {
    return (counter >= roadpose_e2e_counter_max(profile)) ? 0u : (uint8_t)(counter + 1u);
}

bool roadpose_e2e_config_valid(const roadpose_e2e_config_t *config) {
    return (config != NULL) && (roadpose_e2e_counter_max(config->profile) != 0u) && (config->max_delta >= 1u) &&
           (config->max_delta <= 14u);
}

bool roadpose_e2e_protect(const roadpose_e2e_config_t *config, uint8_t counter, uint8_t data[8]) {
    if ((data == NULL) || !roadpose_e2e_config_valid(config) || (counter > roadpose_e2e_counter_max(config->profile))) {
        return false;
    }
    if (config->profile == ROADPOSE_E2E_PROFILE_5) {
        data[2] = counter;
    } else {
        data[1] = (uint8_t)((data[1] & 0xF0u) | counter);
    }
    uint16_t crc = roadpose_e2e_crc(config, data);
    data[0] = (uint8_t)(crc & 0xFFu);
    if (config->profile == ROADPOSE_E2E_PROFILE_5) {
        data[1] = (uint8_t)(crc >> 8);
    }
    return true;
}
