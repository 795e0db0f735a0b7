/* A CAN port for tests. It keeps every frame that it takes, and answers by a script or fails at call N. */
#ifndef FAKE_BUS_H
#define FAKE_BUS_H

#include "roadpose/can.h"

#define FAKE_BUS_FRAMES 4096u

typedef struct {
    uint32_t id;
    uint8_t data[ROADPOSE_CAN_BYTES];
    uint64_t deadline_us;
    unsigned call; /* which call of can_send took it */
} fake_frame_t;

struct roadpose_can_context {
    fake_frame_t frame[FAKE_BUS_FRAMES];
    unsigned frames;
    unsigned sends;     /* calls of can_send */
    unsigned recovers;  /* calls of can_recover */
    unsigned fail_from; /* these calls of can_send answer fail_with; counted from 1, 0: none */
    unsigned fail_to;
    roadpose_can_send_t fail_with;
    bool needs_recover; /* a failure with DOWN or BUS_OFF lasts until can_recover is called */
    bool down;
};

/* An empty bus that takes everything. */
void fake_bus_init(roadpose_can_context_t *bus);
roadpose_can_port_t fake_bus_port(roadpose_can_context_t *bus);

/* The E2E counter of a frame, for profile 1 and 2. */
uint8_t fake_frame_counter(const fake_frame_t *frame);

#endif
