/* The CAN controller of the emulated world: takes every frame at once, and writes them to a log when it is told to, because a
 * driver on the library's stack cannot write files. */
#ifndef ROADPOSE_CAN_QUEUE_H
#define ROADPOSE_CAN_QUEUE_H

#include "candump.h"
#include "roadpose/can_port.h"

#define CAN_QUEUE_FRAMES 3 /* of one cycle */

struct roadpose_can_context {
    roadpose_candump_t log;
    unsigned count;
    uint32_t id[CAN_QUEUE_FRAMES];
    uint8_t data[CAN_QUEUE_FRAMES][ROADPOSE_CAN_BYTES];
};

/* can_send of the port; ROADPOSE_CAN_FULL beyond one cycle's frames. */
roadpose_can_send_t can_queue_send(roadpose_can_context_t *bus, uint32_t id, const uint8_t data[8], uint64_t deadline_us);

/* Writes what was sent. */
void can_queue_log(roadpose_can_context_t *bus, uint64_t time_us);

#endif
