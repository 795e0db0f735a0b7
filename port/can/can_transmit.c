/* The sender. Each cycle three frames are made from the newest estimate and offered to the port until it takes them or
 * the cycle is over. Nothing is queued beyond that: a queue would send old poses late. */
#include "roadpose/can.h"

#include <stddef.h>
#include <string.h>

#define NONE_SENT 0xFFFFu

roadpose_can_result_t roadpose_can_transmit_init(roadpose_can_transmit_t *transmit,
                                                 const roadpose_can_settings_t *settings,
                                                 const roadpose_can_port_t *port) {
    roadpose_can_settings_t defaults;
    if ((transmit == NULL) || (port == NULL) || (port->can_send == NULL)) {
        return ROADPOSE_CAN_ERROR_NULL;
    }
    (void)roadpose_can_settings_default(&defaults, ROADPOSE_E2E_PROFILE_1);
    const roadpose_can_settings_t *chosen = (settings != NULL) ? settings : &defaults;
    if (!roadpose_can_settings_valid(chosen)) {
        return ROADPOSE_CAN_ERROR_SETTINGS;
    }
    (void)memset(transmit, 0, sizeof *transmit);
    transmit->settings = *chosen;
    transmit->port = *port;
    for (unsigned message = 0; message < ROADPOSE_CAN_MESSAGES; message++) {
        transmit->slot[message].counter = ROADPOSE_E2E_FIRST_COUNTER;
        transmit->slot[message].sent = NONE_SENT;
    }
    return ROADPOSE_CAN_DONE;
}

void roadpose_can_transmit_publish(roadpose_can_transmit_t *transmit, const roadpose_can_estimate_t *estimate,
                                   uint32_t overwritten, uint64_t time_us) {
    if ((transmit == NULL) || (estimate == NULL)) {
        return;
    }
    transmit->newest = *estimate;
    transmit->newest_us = time_us;
    transmit->has_estimate = true;
    transmit->counts.estimates++;
    transmit->counts.overwritten = overwritten;
    if (estimate->pose_status != (uint8_t)ROADPOSE_STATUS_OK) {
        transmit->counts.refused++;
    }
}

static void step_counter(roadpose_can_transmit_t *transmit, unsigned message) {
    roadpose_can_slot_t *slot = &transmit->slot[message];
    uint8_t profile = transmit->settings.e2e[message].profile;
    slot->counter = roadpose_e2e_next_counter(profile, slot->counter);
    if (slot->counter == slot->sent) { /* an outage has gone once round: this would be taken for a repetition */
        slot->counter = roadpose_e2e_next_counter(profile, slot->counter);
    }
}

/* A frame for which there was no room was never sent, so the next one takes its counter. A frame that met a dead bus is
 * lost to the receivers, and the gap in the counter tells them. */
static void give_up_waiting(roadpose_can_transmit_t *transmit) {
    for (unsigned message = 0; message < ROADPOSE_CAN_MESSAGES; message++) {
        if (transmit->slot[message].waits) {
            transmit->slot[message].waits = false;
            transmit->counts.dropped++;
            if (transmit->bus_down) {
                step_counter(transmit, message);
            }
        }
    }
}

/* An estimate may be dated a little after the cycle that sends it, where the caller takes the time once a task. Dated
 * further ahead it has another clock, or the clock was set back: its age cannot be told, so it must not count as new. */
static void forget_stale(roadpose_can_transmit_t *transmit, uint64_t now_us) {
    bool ahead = transmit->newest_us > now_us;
    uint64_t apart_us = ahead ? (transmit->newest_us - now_us) : (now_us - transmit->newest_us);
    uint32_t allowed_us = ahead ? transmit->settings.cycle_us : transmit->settings.max_age_us;
    if (apart_us > allowed_us) {
        transmit->has_estimate = false;
    }
}

static roadpose_can_status_t current_status(const roadpose_can_transmit_t *transmit) {
    roadpose_can_status_t status;
    bool known = transmit->has_estimate;
    status.valid = ROADPOSE_CAN_FRAME_COUNT | ROADPOSE_CAN_REFUSED_COUNT | ROADPOSE_CAN_OVERWRITTEN_COUNT |
                   ROADPOSE_CAN_DROPPED_COUNT;
    status.pose_status = known ? transmit->newest.pose_status : ROADPOSE_CAN_STATUS_NO_FRAME;
    status.yaw_status = known ? transmit->newest.yaw_status : ROADPOSE_CAN_STATUS_INVALID;
    status.frame_count = transmit->counts.estimates;
    status.refused_count = transmit->counts.refused;
    status.overwritten_count = transmit->counts.overwritten;
    status.dropped_count = transmit->counts.dropped;
    return status;
}

static void make_frames(roadpose_can_transmit_t *transmit) {
    const roadpose_can_estimate_t *known = transmit->has_estimate ? &transmit->newest : NULL;
    const roadpose_can_status_t status = current_status(transmit);
    roadpose_can_pack_pose((known != NULL) ? &known->pose : NULL, transmit->slot[ROADPOSE_CAN_MESSAGE_POSE].data);
    roadpose_can_pack_quality((known != NULL) ? &known->quality : NULL,
                              transmit->slot[ROADPOSE_CAN_MESSAGE_QUALITY].data);
    roadpose_can_pack_status(&status, transmit->slot[ROADPOSE_CAN_MESSAGE_STATUS].data);
    for (unsigned message = 0; message < ROADPOSE_CAN_MESSAGES; message++) {
        roadpose_can_slot_t *slot = &transmit->slot[message];
        (void)roadpose_e2e_protect(&transmit->settings.e2e[message], slot->counter, slot->data); /* checked at init */
        slot->waits = true;
    }
}

static void note_bus(roadpose_can_transmit_t *transmit) {
    if (transmit->bus_down) {
        transmit->counts.recovered++;
    }
    transmit->bus_down = false;
    transmit->bus_off = false;
}

static void note_sent(roadpose_can_transmit_t *transmit, unsigned message) {
    transmit->slot[message].waits = false;
    transmit->slot[message].sent = transmit->slot[message].counter;
    step_counter(transmit, message);
    transmit->counts.sent++;
    note_bus(transmit);
}

static void note_no_bus(roadpose_can_transmit_t *transmit, bool bus_off) {
    transmit->counts.down += transmit->bus_down ? 0u : 1u;
    transmit->counts.bus_off += (bus_off && !transmit->bus_off) ? 1u : 0u;
    transmit->bus_down = true;
    transmit->bus_off = bus_off;
}

/* A bus that answers "full" is not down: it will take the frame. */
static roadpose_can_result_t note_full(roadpose_can_transmit_t *transmit) {
    transmit->counts.full++;
    note_bus(transmit);
    return ROADPOSE_CAN_WAITING;
}

static roadpose_can_result_t offer(roadpose_can_transmit_t *transmit, unsigned message) {
    uint64_t deadline_us = transmit->start_us + transmit->settings.cycle_us;
    roadpose_can_send_t answer = transmit->port.can_send(transmit->port.context, transmit->settings.id[message],
                                                         transmit->slot[message].data, deadline_us);
    roadpose_can_result_t result = ROADPOSE_CAN_NO_BUS;
    if (answer == ROADPOSE_CAN_SENT) {
        note_sent(transmit, message);
        result = ROADPOSE_CAN_DONE;
    } else if (answer == ROADPOSE_CAN_FULL) {
        result = note_full(transmit);
    } else {
        note_no_bus(transmit, answer == ROADPOSE_CAN_BUS_OFF);
    }
    return result;
}

/* In order, and not past the first that is refused: the messages of a cycle stay together on the bus. */
static roadpose_can_result_t offer_waiting(roadpose_can_transmit_t *transmit) {
    roadpose_can_result_t result = ROADPOSE_CAN_DONE;
    for (unsigned message = 0; (message < ROADPOSE_CAN_MESSAGES) && (result == ROADPOSE_CAN_DONE); message++) {
        if (transmit->slot[message].waits) {
            result = offer(transmit, message);
        }
    }
    return result;
}

roadpose_can_result_t roadpose_can_transmit_poll(roadpose_can_transmit_t *transmit, uint64_t now_us) {
    if (transmit == NULL) {
        return ROADPOSE_CAN_ERROR_NULL;
    }
    if ((now_us - transmit->start_us) >= transmit->settings.cycle_us) {
        give_up_waiting(transmit);
        return transmit->bus_down ? ROADPOSE_CAN_NO_BUS : ROADPOSE_CAN_DONE;
    }
    return offer_waiting(transmit);
}

roadpose_can_result_t roadpose_can_transmit_cycle(roadpose_can_transmit_t *transmit, uint64_t now_us) {
    if (transmit == NULL) {
        return ROADPOSE_CAN_ERROR_NULL;
    }
    give_up_waiting(transmit);
    forget_stale(transmit, now_us);
    transmit->start_us = now_us;
    transmit->counts.cycles++;
    make_frames(transmit);
    if (transmit->bus_down && (transmit->port.can_recover != NULL)) {
        transmit->port.can_recover(transmit->port.context, now_us);
    }
    return offer_waiting(transmit);
}

const roadpose_can_counts_t *roadpose_can_transmit_counts(const roadpose_can_transmit_t *transmit) {
    return (transmit != NULL) ? &transmit->counts : NULL;
}
