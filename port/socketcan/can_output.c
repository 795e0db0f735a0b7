#include "can_output.h"

#include <string.h>

void roadpose_can_output_init(roadpose_can_context_t *output) {
    memset(output, 0, sizeof *output);
}

roadpose_socketcan_result_t roadpose_can_output_add_bus(roadpose_can_context_t *output, const char *interface) {
    output->has_bus = true;
    return roadpose_socketcan_open(&output->bus, interface);
}

bool roadpose_can_output_add_log(roadpose_can_context_t *output, const char *path, const char *interface) {
    output->has_log = roadpose_candump_open(&output->log, path, interface);
    return output->has_log;
}

static roadpose_can_send_t output_send(roadpose_can_context_t *output, uint32_t id, const uint8_t data[8],
                                       uint64_t deadline_us) {
    roadpose_can_send_t answer = ROADPOSE_CAN_SENT;
    (void)deadline_us; /* the socket's queue is kept short instead */
    if (output->has_bus)
        answer = roadpose_socketcan_send(&output->bus, id, data);
    if (output->has_log && answer == ROADPOSE_CAN_SENT)
        roadpose_candump_write(&output->log, output->now_us, id, data);
    return answer;
}

static void output_recover(roadpose_can_context_t *output, uint64_t now_us) {
    if (output->has_bus)
        roadpose_socketcan_recover(&output->bus, now_us);
}

roadpose_can_port_t roadpose_can_output_port(roadpose_can_context_t *output) {
    const roadpose_can_port_t port = {output, output_send, output_recover};
    return port;
}

bool roadpose_can_output_close(roadpose_can_context_t *output) {
    bool complete = true;
    if (output->has_bus)
        roadpose_socketcan_close(&output->bus);
    if (output->has_log)
        complete = roadpose_candump_close(&output->log);
    output->has_bus = false;
    output->has_log = false;
    return complete;
}
