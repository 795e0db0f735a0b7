/* roadpose: what a platform supplies so that the library can send on its CAN controller.
 *
 * The port is this struct of functions and a context. All functions are called from the task that calls
 * roadpose_can_transmit_cycle() and roadpose_can_transmit_poll(), never from an interrupt, never two at a time for one
 * transmitter. Nobody reads a clock inside: time is an argument of the calls that the platform makes, microseconds from
 * any start that never run backwards.
 *
 * No function of a port may block, wait for another task, call back into the transmitter that called it, or keep a
 * pointer to data after it has returned.
 */
#ifndef ROADPOSE_CAN_PORT_H
#define ROADPOSE_CAN_PORT_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define ROADPOSE_CAN_BYTES 8u                           /* of every frame */
#define ROADPOSE_CAN_EXTENDED UINT32_C(0x80000000)      /* or-ed to an identifier: 29 bits instead of 11 */
#define ROADPOSE_CAN_STANDARD_MASK UINT32_C(0x000007FF) /* largest 11-bit identifier */
#define ROADPOSE_CAN_EXTENDED_MASK UINT32_C(0x1FFFFFFF) /* largest 29-bit identifier */

/* Answers of can_send. Any other value is taken as ROADPOSE_CAN_DOWN. */
typedef enum {
    ROADPOSE_CAN_SENT = 0,    /* controller or driver has taken the frame over: its bytes are copied */
    ROADPOSE_CAN_FULL = 1,    /* no room now: ordinary. The frame was not taken; it is offered again */
    ROADPOSE_CAN_DOWN = -1,   /* the interface does not exist, is not started or has an error. Not taken */
    ROADPOSE_CAN_BUS_OFF = -2 /* the controller has left the bus. Not taken */
} roadpose_can_send_t;

/* Whatever the platform's functions need. The platform defines the struct; the transmitter only passes it on. */
typedef struct roadpose_can_context roadpose_can_context_t;

typedef struct {
    roadpose_can_context_t *context; /* handed to every function; may be NULL if they do without */

    /* Offers one frame. Required. id: 11 bits, or 29 bits with ROADPOSE_CAN_EXTENDED. data: 8 bytes, valid during the
     * call. deadline_us: from this time on the frame is worthless; a driver that queues may throw it away then, and
     * must never send it later in place of a newer one. Called at most three times by one cycle or poll.
     * May: write a mailbox of the controller, put into a queue. May not: wait until there is room. */
    roadpose_can_send_t (*can_send)(roadpose_can_context_t *context, uint32_t id, const uint8_t data[8],
                                    uint64_t deadline_us);

    /* Starts to bring the bus back: restart a controller that is bus-off, open an interface again. NULL where the
     * hardware does it itself. Called at most once a cycle, before the cycle's first can_send, while the last answer of
     * can_send was DOWN or BUS_OFF. now_us: as the cycle got it, for ports that want to try more rarely.
     * May: write a command to the controller. May not: wait for its effect; the next can_send tells. */
    void (*can_recover)(roadpose_can_context_t *context, uint64_t now_us);
} roadpose_can_port_t;

#ifdef __cplusplus
}
#endif

#endif
