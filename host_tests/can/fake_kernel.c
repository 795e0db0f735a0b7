#define _DEFAULT_SOURCE

#include "fake_kernel.h"

#include <errno.h>
#include <net/if.h>
#include <stdarg.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>

#define FAKE_SOCKET 77

fake_kernel_t kernel;

/* The calls that the linker puts in place of the system's. */
int __wrap_socket(int family, int type, int protocol);
int __wrap_ioctl(int fd, unsigned long request, ...);
int __wrap_setsockopt(int fd, int level, int name, const void *value, socklen_t size);
int __wrap_bind(int fd, const struct sockaddr *address, socklen_t size);
ssize_t __wrap_send(int fd, const void *bytes, size_t count, int flags);
ssize_t __wrap_recv(int fd, void *bytes, size_t count, int flags);
int __wrap_close(int fd);

void fake_kernel_init(void) {
    memset(&kernel, 0, sizeof kernel);
    kernel.has_can = true;
    kernel.has_vcan = true;
    kernel.is_up = true;
}

void fake_kernel_set_up(bool up) {
    if (kernel.is_up && !up && kernel.is_bound)
        kernel.pending_error = ENETDOWN;
    kernel.is_up = up;
}

void fake_kernel_remove(void) {
    fake_kernel_set_up(false);
    kernel.has_vcan = false;
    kernel.is_bound = false;
    kernel.pending_error = ENODEV;
}

void fake_kernel_report(uint32_t error_frame) {
    kernel.error_frames[kernel.error_count++] = error_frame | CAN_ERR_FLAG;
}

/* Counts the call; true when it is to fail. */
static bool fails(void) {
    kernel.calls++;
    if (kernel.calls == kernel.fail_at)
        errno = kernel.fail_errno;
    return kernel.calls == kernel.fail_at;
}

static int refuse(int reason) {
    errno = reason;
    return -1;
}

int __wrap_socket(int family, int type, int protocol) {
    (void)protocol;
    if (fails())
        return -1;
    kernel.is_nonblocking = (type & SOCK_NONBLOCK) != 0;
    kernel.hears_data = true;
    kernel.error_mask = 0;
    kernel.send_buffer = -1;
    if (!kernel.has_can || family != PF_CAN)
        return refuse(EAFNOSUPPORT);
    kernel.is_open = true;
    kernel.opened++;
    kernel.pending_error = 0;
    return FAKE_SOCKET;
}

int __wrap_ioctl(int fd, unsigned long request, ...) {
    va_list arguments;
    struct ifreq *interface;
    va_start(arguments, request);
    interface = va_arg(arguments, struct ifreq *);
    va_end(arguments);
    if (fails())
        return -1;
    if (fd != FAKE_SOCKET || (request != SIOCGIFINDEX && request != SIOCGIFFLAGS))
        return refuse(EBADF);
    if (!kernel.has_vcan || strcmp(interface->ifr_name, "vcan0") != 0)
        return refuse(ENODEV);
    if (request == SIOCGIFINDEX)
        interface->ifr_ifindex = 3;
    else
        interface->ifr_flags = (short)(!kernel.is_up ? 0 : kernel.has_no_carrier ? IFF_UP : IFF_UP | IFF_RUNNING);
    return 0;
}

int __wrap_setsockopt(int fd, int level, int name, const void *value, socklen_t size) {
    if (fails())
        return -1;
    if (level == SOL_CAN_RAW && name == CAN_RAW_FILTER && size == 0)
        kernel.hears_data = false;
    if (level == SOL_CAN_RAW && name == CAN_RAW_ERR_FILTER && size == sizeof kernel.error_mask)
        memcpy(&kernel.error_mask, value, sizeof kernel.error_mask);
    if (level == SOL_SOCKET && name == SO_SNDBUF && size == sizeof kernel.send_buffer)
        memcpy(&kernel.send_buffer, value, sizeof kernel.send_buffer);
    return fd == FAKE_SOCKET ? 0 : refuse(EBADF);
}

int __wrap_bind(int fd, const struct sockaddr *address, socklen_t size) {
    struct sockaddr_can can;
    if (fails())
        return -1;
    if (fd != FAKE_SOCKET || size != sizeof can)
        return refuse(EINVAL);
    memcpy(&can, address, sizeof can);
    if (can.can_ifindex != 3)
        return refuse(ENODEV);
    kernel.is_bound = true;
    kernel.pending_error = kernel.is_up ? 0 : ENETDOWN;
    return 0;
}

/* What Linux answers, in its order: no interface, interface down, an error that was kept for this call, no room. */
static int reason_not_to_send(void) {
    int reason = 0;
    kernel.sends++;
    if (kernel.sends >= kernel.refused.from && kernel.sends <= kernel.refused.to)
        reason = kernel.refused_errno;
    else if (!kernel.is_bound)
        reason = ENXIO;
    else if (kernel.pending_error != 0)
        reason = kernel.pending_error;
    else if (!kernel.is_up)
        reason = ENETDOWN;
    else if (kernel.is_full)
        reason = ENOBUFS;
    kernel.pending_error = 0;
    return reason;
}

ssize_t __wrap_send(int fd, const void *bytes, size_t count, int flags) {
    const struct can_frame *frame = bytes;
    int reason;
    kernel.may_block = kernel.may_block || (!kernel.is_nonblocking && (flags & MSG_DONTWAIT) == 0);
    if (fails())
        return -1;
    reason = (fd == FAKE_SOCKET && kernel.is_open) ? reason_not_to_send() : EBADF;
    if (reason != 0)
        return refuse(reason);
    if (count != sizeof *frame || frame->can_dlc != 8)
        return refuse(EINVAL);
    if (kernel.frames < KERNEL_FRAMES) {
        kernel.frame[kernel.frames].id = frame->can_id;
        memcpy(kernel.frame[kernel.frames].data, frame->data, 8);
        kernel.frames++;
    }
    return (ssize_t)count;
}

ssize_t __wrap_recv(int fd, void *bytes, size_t count, int flags) {
    struct can_frame frame;
    kernel.may_block = kernel.may_block || (!kernel.is_nonblocking && (flags & MSG_DONTWAIT) == 0);
    if (fails())
        return -1;
    if (fd != FAKE_SOCKET || count != sizeof frame)
        return refuse(EBADF);
    if (kernel.pending_error != 0) {
        const int reason = kernel.pending_error;
        kernel.pending_error = 0;
        return refuse(reason);
    }
    kernel.recvs++;
    if (kernel.bus_off.to != 0 && (kernel.recvs == kernel.bus_off.from || kernel.recvs == kernel.bus_off.to))
        fake_kernel_report(kernel.recvs == kernel.bus_off.from ? CAN_ERR_BUSOFF : CAN_ERR_RESTARTED);
    if (kernel.error_count == 0)
        return refuse(EAGAIN);
    memset(&frame, 0, sizeof frame);
    frame.can_id = kernel.error_frames[0];
    kernel.error_count--;
    memmove(kernel.error_frames, kernel.error_frames + 1, sizeof kernel.error_frames - sizeof kernel.error_frames[0]);
    memcpy(bytes, &frame, sizeof frame);
    return (ssize_t)sizeof frame;
}

int __wrap_close(int fd) {
    kernel.calls++;
    if (fd != FAKE_SOCKET)
        return refuse(EBADF);
    kernel.opened--;
    kernel.is_open = false;
    kernel.is_bound = false;
    return 0;
}
