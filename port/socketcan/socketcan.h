/* roadpose on Linux: a CAN interface by SocketCAN.
 *
 * A raw socket that never blocks and receives nothing but error frames. A full queue (ENOBUFS, EAGAIN), an interface
 * that is down (ENETDOWN) or gone (ENXIO, ENODEV), and a controller that is bus-off are ordinary answers; all are
 * counted, and roadpose_socketcan_recover() opens an interface again that came back or came for the first time.
 * Restarting a controller after bus-off takes the right to configure the network: set `ip link set can0 type can
 * restart-ms 100`, or restart by hand; the port notices it, by the error frame that tells of the restart or, two seconds
 * after bus-off, by the carrier of the interface. An interface that is up without a carrier counts as bus-off: Linux
 * drops what is sent to it and says nothing.
 *
 * On systems without SocketCAN the functions are there and answer ROADPOSE_SOCKETCAN_NO_SUPPORT. Not for interrupts.
 * One object must not be used by two threads at a time; two objects are independent.
 */
#ifndef ROADPOSE_SOCKETCAN_H
#define ROADPOSE_SOCKETCAN_H

#include <stdbool.h>
#include <stdint.h>

#include "roadpose/can_port.h"

#define ROADPOSE_SOCKETCAN_NAME_BYTES 16u /* of an interface name, the closing zero included: Linux' own limit */

typedef enum {
    ROADPOSE_SOCKETCAN_OPEN = 0,
    ROADPOSE_SOCKETCAN_NO_SUPPORT = 1,   /* this kernel has no CAN, or this system no SocketCAN */
    ROADPOSE_SOCKETCAN_NO_INTERFACE = 2, /* there is no interface of this name: now, it may come */
    ROADPOSE_SOCKETCAN_BAD_NAME = 3,     /* empty or longer than 15 characters: it will never come */
    ROADPOSE_SOCKETCAN_REFUSED = 4       /* the system refused; last_errno says why */
} roadpose_socketcan_result_t;

/* All run over at 2^32. */
typedef struct {
    uint32_t sent;
    uint32_t full;    /* answers FULL */
    uint32_t down;    /* answers DOWN */
    uint32_t bus_off; /* error frames that said bus-off */
    uint32_t opened;  /* times that the interface was opened */
} roadpose_socketcan_counts_t;

/* Private members but counts and last_errno, which may be read. */
typedef struct {
    int socket; /* -1: closed */
    bool is_bus_off;
    bool is_dated;       /* bus_off_us is known */
    uint64_t bus_off_us; /* when recover heard of it first */
    char name[ROADPOSE_SOCKETCAN_NAME_BYTES]; /* empty: not to be opened */
    int last_errno;                           /* of the last failure, 0: none yet */
    roadpose_socketcan_counts_t counts;
} roadpose_socketcan_t;

/* Opens the interface. On NO_INTERFACE and REFUSED *can is usable all the same: it answers DOWN, and
 * roadpose_socketcan_recover() tries again. On NO_SUPPORT and BAD_NAME it answers DOWN for ever. Does not wait. */
roadpose_socketcan_result_t roadpose_socketcan_open(roadpose_socketcan_t *can, const char *name);

/* Offers one frame, as roadpose_can_port_t.can_send wants it. The queue of the socket is kept so short (about two
 * cycles) that a frame which was taken does not go out long after its deadline. At most one frame is written, and 16
 * error frames are read; three system calls in the ordinary case. */
roadpose_can_send_t roadpose_socketcan_send(roadpose_socketcan_t *can, uint32_t id, const uint8_t data[8]);

/* Opens again what is closed; of an open interface that is bus-off, looks whether it has been restarted. now_us: as
 * roadpose_can_port_t.can_recover gets it. A few system calls, none of which waits. */
void roadpose_socketcan_recover(roadpose_socketcan_t *can, uint64_t now_us);

/* Closes; what the kernel has taken still goes out. May be called twice. */
void roadpose_socketcan_close(roadpose_socketcan_t *can);

/* A line for people, without line end: "no interface of this name", ... Never NULL; static storage. */
const char *roadpose_socketcan_words(roadpose_socketcan_result_t result);

#endif
