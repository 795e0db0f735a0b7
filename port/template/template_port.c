#include "template_port.h"

#define SLICES_A_TASK 8u /* FILL IN: what one call of the task may cost; see roadpose_frame_slice() */

static void publish(roadpose_template_t *port, const roadpose_pose_t *pose);

/* ---- camera: see include/roadpose/camera_port.h ---- */

static uint32_t camera_lock(roadpose_camera_context_t *camera) {
    (void)camera;
    return 0; /* FILL IN: read the interrupt mask, disable the camera's interrupt, barrier; return the mask */
}

static void camera_unlock(roadpose_camera_context_t *camera, uint32_t state) {
    (void)camera;
    (void)state; /* FILL IN: barrier, restore the interrupt mask */
}

static void camera_frame_release(roadpose_camera_context_t *camera, const roadpose_frame_t *frame, uint32_t frame_id) {
    (void)camera;
    (void)frame;
    (void)frame_id; /* FILL IN: give the buffer back to the driver or the DMA. May run in the interrupt */
}

static void camera_cache_invalidate(roadpose_camera_context_t *camera, const void *address, size_t bytes) {
    (void)camera;
    (void)address;
    (void)bytes; /* FILL IN: invalidate, not clean; set the callback to NULL where memory is coherent */
}

static void camera_pose_ready(roadpose_camera_context_t *camera, uint32_t frame_id, uint64_t time_us,
                              const roadpose_pose_t *pose) {
    (void)frame_id;
    (void)time_us;
    publish(camera->port, pose); /* FILL IN: whoever else on this ECU wants the pose */
}

/* ---- CAN: see include/roadpose/can_port.h ---- */

static roadpose_can_send_t can_send(roadpose_can_context_t *can, uint32_t id, const uint8_t data[8],
                                    uint64_t deadline_us) {
    (void)can;
    (void)id;
    (void)data;
    (void)deadline_us;
    return ROADPOSE_CAN_DOWN; /* FILL IN: is a transmit mailbox free? Write it: SENT. None free: FULL. Never wait */
}

static void can_recover(roadpose_can_context_t *can, uint64_t now_us) {
    (void)can;
    (void)now_us; /* FILL IN: leave bus-off, start the controller; do not wait for it */
}

/* ---- memory over power-off: see include/roadpose/store_port.h ---- */

static bool store(roadpose_store_context_t *context, const void *bytes, size_t count) {
    (void)context;
    (void)bytes;
    (void)count;
    return false; /* FILL IN: queue the record for the non-volatile memory */
}

static bool recall(roadpose_store_context_t *context, void *bytes, size_t count) {
    (void)context;
    (void)bytes;
    (void)count;
    return false; /* FILL IN: copy the newest complete record */
}

/* ---- what joins them: nothing to fill in ---- */

/* pose NULL: the frame was refused. */
static void publish(roadpose_template_t *port, const roadpose_pose_t *pose) {
    roadpose_camera_counters_t counters = {0, 0, 0, 0, 0, 0};
    roadpose_can_estimate_t estimate;
    roadpose_camera_read_counters(&port->camera, &counters);
    roadpose_can_estimate(&estimate, pose);
    roadpose_can_transmit_publish(&port->transmit, &estimate, counters.frames_displaced, port->now_us);
}

bool roadpose_template_init(roadpose_template_t *port, const roadpose_rig_t *rig,
                            const roadpose_disparity_format_t *format) {
    const roadpose_camera_platform_t camera = {&port->camera_context,   camera_lock,
                                               camera_unlock,           camera_frame_release,
                                               camera_cache_invalidate, camera_pose_ready};
    const roadpose_can_port_t can = {&port->can_context, can_send, can_recover};
    port->camera_context.port = port;
    port->can_context.port = port;
    port->has_cycle = false;
    port->now_us = 0;
    port->cycle_us = 0;
    return roadpose_init(&port->estimator, rig, format, NULL) == ROADPOSE_OK &&
           roadpose_camera_init(&port->camera, &camera, &port->estimator) == ROADPOSE_OK &&
           roadpose_can_transmit_init(&port->transmit, NULL, &can) == ROADPOSE_CAN_DONE;
}

void roadpose_template_camera_interrupt(roadpose_template_t *port, const roadpose_frame_t *frame, uint32_t frame_id,
                                        uint64_t time_us) {
    (void)roadpose_camera_frame_ready(&port->camera, frame, frame_id, time_us); /* false only before init */
}

/* A task whose period does not divide the cycle begins it a little late; the next one makes up for it. */
static void serve_can(roadpose_template_t *port) {
    const uint32_t cycle_us = port->transmit.settings.cycle_us;
    const uint64_t past_us = port->now_us - port->cycle_us;
    if (!port->has_cycle || (past_us >= cycle_us)) {
        const bool restarts = !port->has_cycle || ((past_us / 2u) >= cycle_us); /* whole cycles were missed */
        port->cycle_us = restarts ? port->now_us : (port->cycle_us + cycle_us);
        port->has_cycle = true;
        (void)roadpose_can_transmit_cycle(&port->transmit, port->now_us); /* its counters tell what went wrong */
    } else {
        (void)roadpose_can_transmit_poll(&port->transmit, port->now_us);
    }
}

void roadpose_template_task(roadpose_template_t *port, uint64_t now_us) {
    port->now_us = now_us;
    if (roadpose_camera_task(&port->camera, SLICES_A_TASK) == ROADPOSE_CAMERA_REFUSED) {
        publish(port, NULL);
    }
    serve_can(port);
}

roadpose_store_port_t roadpose_template_store_port(void) {
    const roadpose_store_port_t port = {NULL, store, recall};
    return port;
}
