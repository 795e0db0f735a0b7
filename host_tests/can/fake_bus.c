#include "fake_bus.h"

#include <string.h>

static bool fails(const roadpose_can_context_t *bus) {
    bool scripted = (bus->fail_from != 0u) && (bus->sends >= bus->fail_from) && (bus->sends <= bus->fail_to);
    return scripted || bus->down;
}

static roadpose_can_send_t fake_send(roadpose_can_context_t *bus, uint32_t id, const uint8_t data[8],
                                     uint64_t deadline_us) {
    bus->sends++;
    if (fails(bus)) {
        bus->down = bus->needs_recover && (bus->fail_with != ROADPOSE_CAN_FULL);
        return bus->fail_with;
    }
    if (bus->frames < FAKE_BUS_FRAMES) {
        fake_frame_t *frame = &bus->frame[bus->frames];
        frame->id = id;
        memcpy(frame->data, data, ROADPOSE_CAN_BYTES);
        frame->deadline_us = deadline_us;
        frame->call = bus->sends;
        bus->frames++;
    }
    return ROADPOSE_CAN_SENT;
}

static void fake_recover(roadpose_can_context_t *bus, uint64_t now_us) {
    (void)now_us;
    bus->recovers++;
    bus->down = false;
}

void fake_bus_init(roadpose_can_context_t *bus) {
    memset(bus, 0, sizeof *bus);
}

roadpose_can_port_t fake_bus_port(roadpose_can_context_t *bus) {
    const roadpose_can_port_t port = {bus, fake_send, fake_recover};
    return port;
}

uint8_t fake_frame_counter(const fake_frame_t *frame) {
    return (uint8_t)(frame->data[1] & 0x0Fu);
}
