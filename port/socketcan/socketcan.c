#define _DEFAULT_SOURCE /* struct ifreq, SOCK_NONBLOCK */

#include "socketcan.h"

#include <errno.h>
#include <net/if.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>

#define CLOSED (-1)
#define MAX_ERROR_FRAMES 16
#define HOLD_US UINT64_C(2000000) /* Linux may take a second to notice that a carrier has gone */

static roadpose_socketcan_result_t fail(roadpose_socketcan_t *can, roadpose_socketcan_result_t result) {
    can->last_errno = errno;
    if (can->socket != CLOSED) {
        (void)close(can->socket);
        can->socket = CLOSED;
    }
    return result;
}

static bool find_interface(roadpose_socketcan_t *can, int *index) {
    struct ifreq request;
    memset(&request, 0, sizeof request);
    memcpy(request.ifr_name, can->name, sizeof can->name);
    const bool found = ioctl(can->socket, SIOCGIFINDEX, &request) == 0;
    *index = found ? request.ifr_ifindex : 0;
    return found;
}

/* Whether the controller takes part in the bus, as far as Linux knows. One that is bus-off has no carrier, and Linux
 * drops what is sent to it without a word. An interface that is down, or gone, is for the next write to tell. */
static bool has_carrier(const roadpose_socketcan_t *can) {
    struct ifreq request;
    memset(&request, 0, sizeof request);
    memcpy(request.ifr_name, can->name, sizeof can->name);
    const bool known = ioctl(can->socket, SIOCGIFFLAGS, &request) == 0;
    return !known || (request.ifr_flags & IFF_UP) == 0 || (request.ifr_flags & IFF_RUNNING) != 0;
}

/* Error frames only, and the shortest queue that the system allows. None of these is worth failing for: without them
 * the socket still sends. */
static void set_options(const roadpose_socketcan_t *can) {
    const can_err_mask_t errors = CAN_ERR_BUSOFF | CAN_ERR_RESTARTED;
    const int shortest = 0;
    (void)setsockopt(can->socket, SOL_CAN_RAW, CAN_RAW_FILTER, NULL, 0);
    (void)setsockopt(can->socket, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &errors, sizeof errors);
    (void)setsockopt(can->socket, SOL_SOCKET, SO_SNDBUF, &shortest, sizeof shortest);
}

static bool bind_interface(const roadpose_socketcan_t *can, int index) {
    struct sockaddr_can address;
    memset(&address, 0, sizeof address);
    address.can_family = AF_CAN;
    address.can_ifindex = index;
    return bind(can->socket, (const struct sockaddr *)&address, sizeof address) == 0;
}

static roadpose_socketcan_result_t open_again(roadpose_socketcan_t *can) {
    int index;
    can->socket = socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW);
    if (can->socket < 0) {
        const bool supported = errno != EAFNOSUPPORT && errno != EPROTONOSUPPORT;
        can->socket = CLOSED;
        return fail(can, supported ? ROADPOSE_SOCKETCAN_REFUSED : ROADPOSE_SOCKETCAN_NO_SUPPORT);
    }
    if (!find_interface(can, &index))
        return fail(can, errno == ENODEV ? ROADPOSE_SOCKETCAN_NO_INTERFACE : ROADPOSE_SOCKETCAN_REFUSED);
    set_options(can);
    if (!bind_interface(can, index))
        return fail(can, ROADPOSE_SOCKETCAN_REFUSED);
    can->is_bus_off = !has_carrier(can); /* since before this socket could hear of it */
    can->is_dated = false;
    can->counts.opened++;
    return ROADPOSE_SOCKETCAN_OPEN;
}

roadpose_socketcan_result_t roadpose_socketcan_open(roadpose_socketcan_t *can, const char *name) {
    const size_t length = strlen(name);
    memset(can, 0, sizeof *can);
    can->socket = CLOSED;
    if (length == 0 || length >= sizeof can->name)
        return ROADPOSE_SOCKETCAN_BAD_NAME;
    memcpy(can->name, name, length);
    const roadpose_socketcan_result_t result = open_again(can);
    if (result == ROADPOSE_SOCKETCAN_NO_SUPPORT)
        can->name[0] = '\0';
    return result;
}

static void note_error_frame(roadpose_socketcan_t *can, const struct can_frame *frame) {
    if ((frame->can_id & CAN_ERR_FLAG) == 0u)
        return;
    if ((frame->can_id & CAN_ERR_BUSOFF) != 0u) {
        can->is_bus_off = true;
        can->is_dated = false;
        can->counts.bus_off++;
    }
    if ((frame->can_id & CAN_ERR_RESTARTED) != 0u)
        can->is_bus_off = false;
}

/* What the controller reported since the last call. That the interface went down, or vanished, is told here too: a
 * controller that starts afresh is not bus-off, and the write will tell what is now. */
static void read_error_frames(roadpose_socketcan_t *can) {
    struct can_frame frame;
    for (int i = 0; i < MAX_ERROR_FRAMES; i++) {
        const ssize_t got = recv(can->socket, &frame, sizeof frame, MSG_DONTWAIT);
        if (got == (ssize_t)sizeof frame) {
            note_error_frame(can, &frame);
        } else {
            if (got < 0 && errno != EAGAIN && errno != EINTR)
                can->is_bus_off = false;
            return;
        }
    }
}

static bool write_frame(const roadpose_socketcan_t *can, const struct can_frame *frame) {
    return send(can->socket, frame, sizeof *frame, MSG_DONTWAIT) == (ssize_t)sizeof *frame;
}

/* The answer to a failed write. An interface that is gone takes its socket with it. */
static roadpose_can_send_t refused(roadpose_socketcan_t *can, int reason) {
    can->last_errno = reason;
    if (reason == ENOBUFS || reason == EAGAIN || reason == EINTR) {
        can->counts.full++;
        return ROADPOSE_CAN_FULL;
    }
    if (reason != ENETDOWN) {
        (void)close(can->socket);
        can->socket = CLOSED;
    }
    can->counts.down++;
    return ROADPOSE_CAN_DOWN;
}

static roadpose_can_send_t write_or_tell(roadpose_socketcan_t *can, const struct can_frame *frame) {
    bool taken = write_frame(can, frame);
    /* The kernel reports once, on the next call, that the interface had gone down; it may be up again since. */
    if (!taken && errno == ENETDOWN)
        taken = write_frame(can, frame);
    if (!taken)
        return refused(can, errno);
    can->counts.sent++;
    return ROADPOSE_CAN_SENT;
}

roadpose_can_send_t roadpose_socketcan_send(roadpose_socketcan_t *can, uint32_t id, const uint8_t data[8]) {
    struct can_frame frame;
    if (can->socket == CLOSED) {
        can->counts.down++;
        return ROADPOSE_CAN_DOWN;
    }
    read_error_frames(can);
    if (can->is_bus_off)
        return ROADPOSE_CAN_BUS_OFF;
    memset(&frame, 0, sizeof frame);
    frame.can_id = id; /* the extended bit is the kernel's own */
    frame.can_dlc = CAN_MAX_DLEN;
    memcpy(frame.data, data, CAN_MAX_DLEN);
    return write_or_tell(can, &frame);
}

/* The restart may never be told: where it was the interface going down and up, the error frame of the bus-off may even
 * be read after it. So the carrier decides, once Linux has had the time to notice. */
static void look_for_restart(roadpose_socketcan_t *can, uint64_t now_us) {
    if (!can->is_dated)
        can->bus_off_us = now_us;
    can->is_dated = true;
    if (now_us - can->bus_off_us >= HOLD_US && has_carrier(can))
        can->is_bus_off = false;
}

void roadpose_socketcan_recover(roadpose_socketcan_t *can, uint64_t now_us) {
    if (can->socket != CLOSED && can->is_bus_off)
        look_for_restart(can, now_us);
    if (can->socket == CLOSED && can->name[0] != '\0')
        (void)open_again(can);
}

void roadpose_socketcan_close(roadpose_socketcan_t *can) {
    if (can->socket != CLOSED)
        (void)close(can->socket);
    can->socket = CLOSED;
    can->name[0] = '\0';
}
