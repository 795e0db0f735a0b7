#include "can_bus.h"

#include <errno.h>
#include <inttypes.h>
#include <string.h>

#include "fault.h"

#define LOG_INTERFACE "can0" /* what a log without a bus calls it */
#define CYCLE_MIN_US 1000u
#define CYCLE_MAX_US 10000000u

static bool open_interface(can_bus_t *bus) {
    const roadpose_socketcan_result_t result = roadpose_can_output_add_bus(&bus->output, bus->interface);

    if (result == ROADPOSE_SOCKETCAN_OPEN)
        return true;
    if (result == ROADPOSE_SOCKETCAN_NO_SUPPORT || result == ROADPOSE_SOCKETCAN_BAD_NAME)
        return fault(bus->interface, "%s", roadpose_socketcan_words(result));
    (void)fault(bus->interface, "%s (%s); playing on, and waiting for it", roadpose_socketcan_words(result),
                strerror(bus->output.bus.last_errno));
    return true;
}

static bool open_log(can_bus_t *bus) {
    const char *const interface = bus->interface != NULL ? bus->interface : LOG_INTERFACE;

    return roadpose_can_output_add_log(&bus->output, bus->log_path, interface) ||
           fault(bus->log_path, "cannot be written: %s", strerror(errno));
}

static bool begin_transmit(can_bus_t *bus, unsigned e2e_profile, uint64_t cycle_us) {
    const roadpose_can_port_t port = roadpose_can_output_port(&bus->output);
    const uint64_t at_least = cycle_us > CYCLE_MIN_US ? cycle_us : CYCLE_MIN_US;
    roadpose_can_settings_t settings;

    if (!roadpose_can_settings_default(&settings, (roadpose_e2e_profile_t)e2e_profile))
        return fault(NULL, "there is no E2E profile %u", e2e_profile);
    settings.cycle_us = (uint32_t)(at_least < CYCLE_MAX_US ? at_least : CYCLE_MAX_US);
    return roadpose_can_transmit_init(&bus->transmit, &settings, &port) == ROADPOSE_CAN_DONE ||
           fault(NULL, "the CAN sender refuses its settings");
}

bool can_bus_open(can_bus_t *bus, const options_t *options, uint64_t cycle_us) {
    bus->interface = options->can_interface;
    bus->log_path = options->candump_path;
    bus->is_on = bus->interface != NULL || bus->log_path != NULL;
    if (!bus->is_on)
        return true;
    roadpose_can_output_init(&bus->output);
    return begin_transmit(bus, options->e2e_profile, cycle_us) && (bus->interface == NULL || open_interface(bus)) &&
           (bus->log_path == NULL || open_log(bus));
}

void can_bus_pose(can_bus_t *bus, const roadpose_pose_t *pose) {
    roadpose_can_estimate(&bus->estimate, pose);
    bus->has_estimate = true;
}

void can_bus_yaw(can_bus_t *bus, int32_t yaw_urad, uint8_t yaw_status) {
    roadpose_can_estimate_yaw(&bus->estimate, yaw_urad, yaw_status);
}

/* Each change is told once, not at every frame. */
static void report_changes(can_bus_t *bus) {
    const roadpose_can_counts_t *counts = roadpose_can_transmit_counts(&bus->transmit);

    if (counts->down != bus->reported.down)
        (void)fault(bus->interface, "down (%s); CAN frames are dropped until it is back",
                    counts->bus_off != bus->reported.bus_off ? "bus-off" : strerror(bus->output.bus.last_errno));
    else if (counts->bus_off != bus->reported.bus_off)
        (void)fault(bus->interface, "bus-off");
    if (counts->recovered != bus->reported.recovered)
        (void)fault(bus->interface, "back; %" PRIu32 " CAN frames dropped so far", counts->dropped);
    bus->reported = *counts;
}

/* What the last cycle left behind while the bus was there, the queue had no room for. */
static void report_queue(can_bus_t *bus, bool was_down) {
    const roadpose_can_counts_t *counts = roadpose_can_transmit_counts(&bus->transmit);
    const bool has_dropped = counts->dropped != bus->dropped;

    bus->dropped = counts->dropped;
    if (was_down)
        return;
    if (has_dropped && !bus->is_full)
        (void)fault(bus->interface, "its queue is full; CAN frames are dropped until there is room");
    if (bus->is_full && !has_dropped)
        (void)fault(bus->interface, "its queue has room again; %" PRIu32 " CAN frames dropped so far", counts->dropped);
    bus->is_full = has_dropped;
}

static bool report_log(can_bus_t *bus) {
    const int error = bus->output.log.error;

    if (error != 0 && !bus->is_log_reported)
        (void)fault(strcmp(bus->log_path, "-") == 0 ? "standard output" : bus->log_path, "cannot be written: %s",
                    strerror(error));
    bus->is_log_reported = error != 0;
    return error == 0;
}

static bool waits(can_bus_t *bus, roadpose_can_result_t result) {
    report_changes(bus);
    (void)report_log(bus);
    bus->is_down = result == ROADPOSE_CAN_NO_BUS;
    return result == ROADPOSE_CAN_WAITING;
}

bool can_bus_cycle(can_bus_t *bus, uint64_t time_us) {
    if (!bus->is_on)
        return false;
    bus->output.now_us = time_us;
    if (bus->has_estimate)
        roadpose_can_transmit_publish(&bus->transmit, &bus->estimate, 0, time_us); /* no frame is ever displaced here */
    bus->has_estimate = false;
    const roadpose_can_result_t result = roadpose_can_transmit_cycle(&bus->transmit, time_us);
    report_queue(bus, bus->is_down);
    return waits(bus, result);
}

bool can_bus_poll(can_bus_t *bus, uint64_t time_us) {
    if (!bus->is_on)
        return false;
    bus->output.now_us = time_us;
    return waits(bus, roadpose_can_transmit_poll(&bus->transmit, time_us));
}

static void report_end(const can_bus_t *bus) {
    const roadpose_can_counts_t *counts = roadpose_can_transmit_counts(&bus->transmit);

    (void)fault(bus->interface,
                "%" PRIu32 " CAN frames sent, %" PRIu32 " dropped; down %" PRIu32 " times (bus-off %" PRIu32
                "), queue full %" PRIu32 " times",
                counts->sent, counts->dropped, counts->down, counts->bus_off, counts->full);
}

bool can_bus_close(can_bus_t *bus) {
    if (!bus->is_on)
        return true;
    if (bus->interface != NULL && bus->transmit.counts.cycles > 0)
        report_end(bus);
    (void)roadpose_can_output_close(&bus->output);
    bus->is_on = false;
    return report_log(bus);
}
