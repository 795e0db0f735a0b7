/* Where a Linux program's CAN frames go: to an interface, to a log, or to both. It is the platform side of
 * roadpose_can_port_t; with an interface and a log, the log has what the interface took. */
#ifndef ROADPOSE_CAN_OUTPUT_H
#define ROADPOSE_CAN_OUTPUT_H

#include "candump.h"
#include "socketcan.h"

struct roadpose_can_context {
    bool has_bus;
    bool has_log;
    uint64_t now_us; /* time of the log's lines; set it before each cycle and poll */
    roadpose_socketcan_t bus;
    roadpose_candump_t log;
};

/* Nowhere yet: frames are taken and forgotten. */
void roadpose_can_output_init(roadpose_can_context_t *output);

/* Adds the interface; see roadpose_socketcan_open(). Anything but NO_SUPPORT and BAD_NAME leaves an output that sends
 * as soon as the interface is there. */
roadpose_socketcan_result_t roadpose_can_output_add_bus(roadpose_can_context_t *output, const char *interface);

/* Adds the log; see roadpose_candump_open(). */
bool roadpose_can_output_add_log(roadpose_can_context_t *output, const char *path, const char *interface);

/* The port for roadpose_can_transmit_init(). *output must live as long as it is used. */
roadpose_can_port_t roadpose_can_output_port(roadpose_can_context_t *output);

/* Closes both. Returns false when the log is not complete. */
bool roadpose_can_output_close(roadpose_can_context_t *output);

#endif
