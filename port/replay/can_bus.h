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
    roadpose_can_estimate_t estimate; /* of this frame, until the next cycle */
    bool has_estimate;
    roadpose_can_counts_t reported; /* what the user has been told of */
    bool is_full;                   /* likewise: a queue that drops frames */
    bool is_log_reported;           /* likewise: a log that cannot be written */
    bool is_down;                   /* as of the last call */
    uint32_t dropped;               /* CAN frames, as of the last cycle */
} can_bus_t;

/* Opens what the options ask for; a CAN cycle is one frame of the recording. An interface that is missing is reported
 * and waited for while playing; what can never work is reported as a fault, and false is returned. */
bool can_bus_open(can_bus_t *bus, const options_t *options, uint64_t cycle_us);

/* What the frame came to, for the next cycle; the yaw, where there is one, after the pose. yaw_status 0: yaw_urad
 * holds. */
void can_bus_pose(can_bus_t *bus, const roadpose_pose_t *pose);
void can_bus_yaw(can_bus_t *bus, int32_t yaw_urad, uint8_t yaw_status);

/* Begins a cycle, offers again what waits. Both return whether frames wait for room. Times: of the recording. */
bool can_bus_cycle(can_bus_t *bus, uint64_t time_us);
bool can_bus_poll(can_bus_t *bus, uint64_t time_us);

/* Closes, and says how it went when there was a bus. Returns false after a fault: the log is not complete. */
bool can_bus_close(can_bus_t *bus);

#endif
