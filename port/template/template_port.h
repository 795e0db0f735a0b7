/* roadpose: a port to begin with. It compiles, links and does nothing: copy the folder, then fill in what is marked
 * FILL IN. Everything between a camera driver and a CAN controller is here once:
 *
 *     camera's interrupt -> template_camera_interrupt()
 *     every millisecond  -> template_task()              frames in slices, CAN frames in cycles
 */
#ifndef ROADPOSE_TEMPLATE_PORT_H
#define ROADPOSE_TEMPLATE_PORT_H

#include "roadpose/camera_port.h"
#include "roadpose/can.h"
#include "roadpose/store_port.h"

typedef struct roadpose_template roadpose_template_t;

/* The camera and the CAN controller of this platform. FILL IN: channel numbers, register addresses, driver handles. */
struct roadpose_camera_context {
    roadpose_template_t *port;
};

struct roadpose_can_context {
    roadpose_template_t *port;
};

/* Everything that the port needs, in one object: no globals. Place it where the memory is (static, a section). Members
 * are private to the port. */
struct roadpose_template {
    struct roadpose_camera_context camera_context;
    struct roadpose_can_context can_context;
    roadpose_t estimator;
    roadpose_camera_port_t camera;
    roadpose_can_transmit_t transmit;
    uint64_t now_us;   /* of the running task */
    uint64_t cycle_us; /* start of the running CAN cycle */
    bool has_cycle;    /* a CAN cycle has begun */
};

/* Makes the port ready; call it before the interrupts are enabled. Returns false when rig, format or settings are
 * refused. Constant time. */
bool roadpose_template_init(roadpose_template_t *port, const roadpose_rig_t *rig,
                            const roadpose_disparity_format_t *format);

/* To be called by the camera's interrupt when a disparity map is complete. Hands it over and returns. */
void roadpose_template_camera_interrupt(roadpose_template_t *port, const roadpose_frame_t *frame, uint32_t frame_id,
                                        uint64_t time_us);

/* To be called cyclically, at least once in a CAN cycle; more often serves a full CAN queue sooner. now_us: any clock
 * in microseconds that does not run backwards. Cost: 8 slices of a frame, and a CAN cycle or poll. */
void roadpose_template_task(roadpose_template_t *port, uint64_t now_us);

/* Store and recall; context is NULL. */
roadpose_store_port_t roadpose_template_store_port(void);

#endif
