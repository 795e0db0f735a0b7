/* A kernel with one CAN interface, in place of the system calls of port/socketcan (the linker's --wrap). It can be
 * taken down and up, vanish and come back, fill up, go bus-off and restart; and any call can be made to fail at call N.
 */
#ifndef FAKE_KERNEL_H
#define FAKE_KERNEL_H

#include <stdbool.h>
#include <stdint.h>

#define KERNEL_FRAMES 1024

/* Calls from...to of one function, counted from 1; to 0: none. */
typedef struct {
    int from;
    int to;
} fake_calls_t;

typedef struct {
    bool has_can;  /* AF_CAN */
    bool has_vcan; /* the interface "vcan0" exists */
    bool is_up;
    bool is_full;
    bool has_no_carrier;
    bool may_block;       /* a call that may wait was made */
    bool hears_data;      /* the socket receives data frames */
    uint32_t error_mask;  /* which error frames it receives */
    int send_buffer;      /* as asked for; -1: not at all */
    int pending_error; /* reported once by the next send or recv */
    uint32_t error_frames[4];
    int error_count;
    fake_calls_t refused; /* these calls of send fail with refused_errno */
    int refused_errno;
    fake_calls_t bus_off; /* the first of these calls of recv reads that the controller is bus-off, the last that it
                             has been restarted */
    int sends;
    int recvs;
    int calls;
    int fail_at; /* this call fails with fail_errno; 0: none */
    int fail_errno;
    bool is_open;
    bool is_nonblocking;
    bool is_bound;
    int opened; /* sockets open now; more than one is a leak */
    int frames;
    struct {
        uint32_t id;
        uint8_t data[8];
    } frame[KERNEL_FRAMES];
} fake_kernel_t;

extern fake_kernel_t kernel;

/* A kernel with vcan0, which is up. */
void fake_kernel_init(void);
void fake_kernel_set_up(bool up);
void fake_kernel_remove(void); /* the interface vanishes */
void fake_kernel_report(uint32_t error_frame);

#endif
