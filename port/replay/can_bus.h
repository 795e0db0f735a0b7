/* The CAN side of a replay: --can, --candump and --e2e. Without them everything here does nothing. */
#ifndef REPLAY_CAN_BUS_H
#define REPLAY_CAN_BUS_H

#include <stdbool.h>
#include <stdint.h>

#include "can_output.h"
#include "options.h"
#include "roadpose/can.h"

typedef struct {
    bool is_on;
    const char *interface; /* NULL: a log only */
    const char *log_path;  /* NULL: the bus only */
    roadpose_can_context_t output;
    roadpose_can_transmit_t transmit;
    roadpose_can_counts_t reported; /* what the user has been told of */
} can_bus_t;

/* Opens what the options ask for; a CAN cycle is one frame of the recording. An interface that is missing is reported and
 * waited for while playing; what can never work is reported as a fault, and false is returned. */
bool can_bus_open(can_bus_t *bus, const options_t *options, uint64_t cycle_us);

/* The newest pose, for the next cycle. */
void can_bus_publish(can_bus_t *bus, const roadpose_pose_t *pose, uint32_t displaced, uint64_t time_us);

/* Begins a cycle, offers again what waits. Both return whether frames wait for room. Times are those of the recording. */
bool can_bus_cycle(can_bus_t *bus, uint64_t time_us);
bool can_bus_poll(can_bus_t *bus, uint64_t time_us);

/* Closes, and says how it went when there was a bus. Returns false after a fault: the log is not complete. */
bool can_bus_close(can_bus_t *bus);

#endif
