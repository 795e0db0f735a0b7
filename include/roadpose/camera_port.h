/* roadpose: from a camera driver's interrupt to a cyclic task.
 *
 * The interrupt only hands over; all work is done by the task. In between is a mailbox of one slot: the newest frame
 * wins, that is the one handed over last (ids and times are not compared), and the frame it displaces goes back to the
 * driver at once. A driver therefore needs at most three buffers: one that it fills, one in the mailbox, one in work.
 *
 *     driver's interrupt                          cyclic task
 *     roadpose_camera_frame_ready()  -> mailbox -> roadpose_camera_task() -> pose_ready(), then frame_release()
 *
 * Every frame that roadpose_camera_frame_ready() accepted is given back by exactly one call of frame_release, whatever
 * becomes of it: finished, displaced, refused or flushed. Until then the driver must not write to it.
 *
 * Sharing. The mailbox and its counters are the only data that both sides touch, and only between lock and unlock. All
 * else belongs to the task. So an interrupt at any point, on this core or on another one, is safe if lock and unlock
 * are right; the port holds the lock for the copy of one slot or the counters, and calls nothing while it does.
 *
 * No globals, no heap, no clock: time is an argument and is passed through. Ports are independent.
 */
#ifndef ROADPOSE_CAMERA_PORT_H
#define ROADPOSE_CAMERA_PORT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "roadpose/roadpose.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Whatever the platform's callbacks need. The platform defines the struct; the port only passes the pointer on. */
typedef struct roadpose_camera_context roadpose_camera_context_t;

/* What the platform supplies. Copied by roadpose_camera_init(). No callback may call roadpose_camera_task(),
 * roadpose_camera_flush() or roadpose_camera_init() of the same port. */
typedef struct {
    roadpose_camera_context_t *context; /* handed to every callback; may be NULL if they do without */

    /* Begins and ends a critical section against the other side. lock returns what unlock needs to restore, for
     * example the interrupt mask before it: both are called from the interrupt too, so they must nest within whatever
     * is masked there. A compiler and memory barrier belongs to each. Both or neither; without them
     * roadpose_camera_frame_ready() must never overlap any other call of the same port (a polled driver).
     * May not: wait for the other side's work, call this library. */
    uint32_t (*lock)(roadpose_camera_context_t *context);
    void (*unlock)(roadpose_camera_context_t *context, uint32_t state);

    /* Gives a buffer back to the driver. Must be given. Called from the task, and for a displaced frame from within
     * roadpose_camera_frame_ready(), so in the interrupt. *frame is valid during the call.
     * May not: block, or call roadpose_camera_frame_ready() from within itself for ever. */
    void (*frame_release)(roadpose_camera_context_t *context, const roadpose_frame_t *frame, uint32_t frame_id);

    /* Drops cached copies of a buffer that DMA has written, before its first byte is read: once for the samples and,
     * where the disparity format uses one, once for the confidence image. bytes counts from the first sample to the last
     * one, stride gaps included. A buffer that does not begin and end on a cache line is the platform's to keep clean;
     * and if the processor ever writes to a buffer, the driver invalidates it before DMA starts as well, lest a dirty
     * line be written over the frame. Called from the task only, after the frame was accepted and before its first
     * slice. NULL: memory is coherent. May not: write dirty lines back over the buffer, block. */
    void (*cache_invalidate)(roadpose_camera_context_t *context, const void *address, size_t bytes);

    /* Takes the result of a frame, whether it has a pose (pose->status) or not. Must be given. Called from the task
     * only, before the frame is released; *pose is valid during the call.
     * May not: block, use the estimator instance of this port for another frame. */
    void (*pose_ready)(roadpose_camera_context_t *context, uint32_t frame_id, uint64_t time_us,
                       const roadpose_pose_t *pose);
} roadpose_camera_platform_t;

/* What became of the frames. Each counter wraps at 2^32.
 * frames_ready = displaced + finished + refused + flushed + the ones in the mailbox and in work (0...2). */
typedef struct {
    uint32_t frames_ready;     /* accepted from the driver */
    uint32_t frames_displaced; /* overwritten in the mailbox by a newer one */
    uint32_t frames_finished;  /* reported by pose_ready */
    uint32_t frames_refused;   /* refused by the estimator: wrong size, wrong stride, ... */
    uint32_t frames_flushed;   /* given up by roadpose_camera_flush() */
    int8_t last_refusal;       /* roadpose_result_t of the last refused frame, ROADPOSE_OK if there was none */
} roadpose_camera_counters_t;

/* What a call of the task did. */
typedef enum {
    ROADPOSE_CAMERA_IDLE = 0,     /* no frame to work on */
    ROADPOSE_CAMERA_WORKING = 1,  /* a frame is in work: call again */
    ROADPOSE_CAMERA_FINISHED = 2, /* pose_ready was called for a frame, and the frame was released */
    ROADPOSE_CAMERA_REFUSED = 3   /* a frame was refused by the estimator, counted and released */
} roadpose_camera_progress_t;

/* A frame with its name. Private, like all of the port. */
typedef struct {
    roadpose_frame_t frame;
    uint32_t id;
    uint64_t time_us;
} roadpose_camera_frame_t;

typedef struct {
    uint32_t ready; /* set last by init */
    roadpose_camera_platform_t platform;
    roadpose_t *instance;
    bool is_full;                        /* the mailbox: both sides, under the lock */
    roadpose_camera_frame_t mailbox;     /* both sides, under the lock */
    bool is_working;                     /* the task's */
    roadpose_camera_frame_t work;        /* the task's */
    roadpose_camera_counters_t counters; /* ready and displaced are the interrupt's, the others the task's */
} roadpose_camera_port_t;

/* Makes *port ready for an initialised instance, which from now on belongs to the port. Call it before the driver's
 * interrupt is enabled; a port in use is to be flushed before, or the frames that it holds never come back. Returns
 * ROADPOSE_OK, or ROADPOSE_ERROR_NULL with *port unchanged: a pointer, frame_release or pose_ready is NULL, or only one
 * of lock and unlock is given. Constant time. */
roadpose_result_t roadpose_camera_init(roadpose_camera_port_t *port, const roadpose_camera_platform_t *platform,
                                       roadpose_t *instance);

/* Interrupt side: hands a frame over. *frame is copied; its buffers are lent until frame_release. frame_id and time_us
 * (when the frame was exposed, on any clock) come back with the pose. Whether the frame fits the rig is found out by
 * the task. Returns false, and the driver keeps the frame, only on a NULL pointer or a port that is not initialised.
 * From one interrupt, or from several. No loop; cost: two copies of a slot, lock and unlock, and one frame_release when
 * a frame is displaced; fewer than 100 instructions of a Cortex-M4 at -Os besides the platform's callbacks. */
bool roadpose_camera_frame_ready(roadpose_camera_port_t *port, const roadpose_frame_t *frame, uint32_t frame_id,
                                 uint64_t time_us);

/* Task side: takes the newest frame if none is in work, and does at most max_slices slices of it (see
 * roadpose_frame_slice() for the cost of one); UINT32_MAX does the whole frame. Ends with the frame: at most one frame
 * a call. A refused frame never blocks the port: it is counted and released, and the next call takes the next one.
 * Returns ROADPOSE_CAMERA_IDLE on NULL or a port that is not initialised. Calls must not overlap. */
roadpose_camera_progress_t roadpose_camera_task(roadpose_camera_port_t *port, uint32_t max_slices);

/* Task side: gives up the frame in work and the one in the mailbox, for example before the driver stops. Does nothing
 * on NULL or a port that is not initialised. Constant time. */
void roadpose_camera_flush(roadpose_camera_port_t *port);

/* Task side: the counters at one moment. Leaves *counters alone on NULL or a port that is not initialised. */
void roadpose_camera_read_counters(const roadpose_camera_port_t *port, roadpose_camera_counters_t *counters);

#ifdef __cplusplus
}
#endif

#endif
