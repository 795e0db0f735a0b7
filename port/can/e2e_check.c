/* AUTOSAR E2E: the receiver's side. One state machine for the three profiles. */
#include "e2e_layout.h"

#include <stddef.h>

/* Steps from one counter to another in a counter of largest + 1 values. */
static uint8_t counter_step(uint8_t from, uint8_t to, uint8_t largest) {
    unsigned values = (unsigned)largest + 1u;
    return (uint8_t)((to + values - from) % values);
}

static void note_missed(roadpose_e2e_receiver_t *receiver) {
    if (receiver->missed < UINT8_MAX) {
        receiver->missed++;
    }
}

/* Cycles that the receiver saw pass without a frame explain as many steps of the counter. Only a step of 0 must never
 * be explained: it is a repetition. */
static roadpose_e2e_status_t judge_step(const roadpose_e2e_config_t *config, const roadpose_e2e_receiver_t *receiver,
                                        uint8_t step) {
    unsigned allowed = (unsigned)config->max_delta + receiver->missed;
    roadpose_e2e_status_t status = ROADPOSE_E2E_WRONG_SEQUENCE;
    if (step == 0u) {
        status = ROADPOSE_E2E_REPEATED;
    } else if (step == 1u) {
        status = ROADPOSE_E2E_OK;
    } else if (step <= allowed) {
        status = ROADPOSE_E2E_SOME_LOST;
    } else {
        /* too far */
    }
    return status;
}

static bool crc_right(const roadpose_e2e_config_t *config, const uint8_t data[8]) {
    return (roadpose_e2e_counter_of(config->profile, data) <= roadpose_e2e_counter_max(config->profile)) &&
           (roadpose_e2e_crc(config, data) == roadpose_e2e_crc_of(config->profile, data));
}

/* A frame whose CRC is right. A wrong sequence becomes the new reference: a sender that restarted is heard again with
 * its next frame, and a single stray frame costs two, not the whole drive. */
static roadpose_e2e_status_t judge_counter(const roadpose_e2e_config_t *config, roadpose_e2e_receiver_t *receiver,
                                           uint8_t counter) {
    roadpose_e2e_status_t status = ROADPOSE_E2E_INITIAL;
    if (receiver->seen) {
        uint8_t step = counter_step(receiver->counter, counter, roadpose_e2e_counter_max(config->profile));
        status = judge_step(config, receiver, step);
    }
    if (status == ROADPOSE_E2E_REPEATED) {
        note_missed(receiver);
    } else {
        receiver->missed = 0;
    }
    receiver->seen = true;
    receiver->counter = counter;
    return status;
}

roadpose_e2e_status_t roadpose_e2e_check(const roadpose_e2e_config_t *config, roadpose_e2e_receiver_t *receiver,
                                         const uint8_t *data) {
    if ((receiver == NULL) || !roadpose_e2e_config_valid(config)) {
        return ROADPOSE_E2E_CRC_ERROR;
    }
    if (data == NULL) {
        note_missed(receiver);
        return ROADPOSE_E2E_NO_NEW_DATA;
    }
    if (!crc_right(config, data)) {
        note_missed(receiver);
        return ROADPOSE_E2E_CRC_ERROR;
    }
    return judge_counter(config, receiver, roadpose_e2e_counter_of(config->profile, data));
}

bool roadpose_e2e_usable(roadpose_e2e_status_t status) {
    return (status == ROADPOSE_E2E_OK) || (status == ROADPOSE_E2E_SOME_LOST) || (status == ROADPOSE_E2E_INITIAL);
}

const char *roadpose_e2e_status_word(roadpose_e2e_status_t status) {
    /* Characters, not pointers: a table of pointers would be relocated, so writable, in position-independent code. */
    static const char words[][16] = {"ok",        "some_lost",  "initial", "repeated", "wrong_sequence",
                                     "crc_error", "no_new_data"};
    unsigned index = (unsigned)status;
    return (index < (sizeof words / sizeof words[0])) ? words[index] : "unknown";
}
