#include "can_queue.h"

#include <string.h>

roadpose_can_send_t can_queue_send(roadpose_can_context_t *bus, uint32_t id, const uint8_t data[8], uint64_t deadline_us) {
    (void)deadline_us;
    if (bus->count == CAN_QUEUE_FRAMES)
        return ROADPOSE_CAN_FULL;
    bus->id[bus->count] = id;
    memcpy(bus->data[bus->count], data, ROADPOSE_CAN_BYTES);
    bus->count++;
    return ROADPOSE_CAN_SENT;
}

void can_queue_log(roadpose_can_context_t *bus, uint64_t time_us) {
    unsigned i;

    for (i = 0; i < bus->count; i++)
        roadpose_candump_write(&bus->log, time_us, bus->id[i], bus->data[i]);
    bus->count = 0;
}
