#include "roadpose/camera_port.h"

#define READY_MARK 0x43414D31u

static uint32_t enter(const roadpose_camera_port_t *port) {
    return port->platform.lock != NULL ? port->platform.lock(port->platform.context) : 0u;
}

static void leave(const roadpose_camera_port_t *port, uint32_t state) {
    if (port->platform.unlock != NULL)
        port->platform.unlock(port->platform.context, state);
}

static bool is_ready(const roadpose_camera_port_t *port) {
    return port != NULL && port->ready == READY_MARK;
}

static void release(const roadpose_camera_port_t *port, const roadpose_camera_frame_t *given) {
    port->platform.frame_release(port->platform.context, &given->frame, given->id);
}

roadpose_result_t roadpose_camera_init(roadpose_camera_port_t *port, const roadpose_camera_platform_t *platform,
                                       roadpose_t *instance) {
    static const roadpose_camera_port_t empty; /* static: all zero, in read-only memory */

    if (port == NULL || platform == NULL || instance == NULL)
        return ROADPOSE_ERROR_NULL;
    if (platform->frame_release == NULL || platform->pose_ready == NULL)
        return ROADPOSE_ERROR_NULL;
    if ((platform->lock == NULL) != (platform->unlock == NULL))
        return ROADPOSE_ERROR_NULL;
    *port = empty;
    port->platform = *platform;
    port->instance = instance;
    port->ready = READY_MARK;
    return ROADPOSE_OK;
}

bool roadpose_camera_frame_ready(roadpose_camera_port_t *port, const roadpose_frame_t *frame, uint32_t frame_id,
                                 uint64_t time_us) {
    roadpose_camera_frame_t displaced;
    bool is_displaced;
    uint32_t state;

    if (!is_ready(port) || frame == NULL)
        return false;
    state = enter(port);
    is_displaced = port->is_full;
    displaced = port->mailbox;
    port->mailbox.frame = *frame;
    port->mailbox.id = frame_id;
    port->mailbox.time_us = time_us;
    port->is_full = true;
    port->counters.frames_ready++;
    port->counters.frames_displaced += is_displaced ? 1u : 0u;
    leave(port, state);
    if (is_displaced)
        release(port, &displaced); /* outside the lock: it is the driver's code */
    return true;
}

/* Empties the mailbox. From here on the frame is the task's, and a newer one no longer displaces it. */
static bool take(roadpose_camera_port_t *port, roadpose_camera_frame_t *taken) {
    const uint32_t state = enter(port);
    const bool is_taken = port->is_full;

    if (is_taken)
        *taken = port->mailbox;
    port->is_full = false;
    leave(port, state);
    return is_taken;
}

static void invalidate(const roadpose_camera_port_t *port, const void *address, uint32_t stride_bytes) {
    const roadpose_frame_t *frame = &port->work.frame;
    const size_t gaps = (size_t)frame->height_px - 1u;

    if (port->platform.cache_invalidate != NULL && address != NULL)
        port->platform.cache_invalidate(port->platform.context, address,
                                        gaps * stride_bytes + 2u * (size_t)frame->width_px);
}

/* Of the buffers that begin has checked. A confidence image that the format does not use has been let go of there: its
 * pointer and stride may be anything, and to drop cache lines by them would destroy other data. */
static void begin_reading(const roadpose_camera_port_t *port) {
    const roadpose_frame_t *checked = &port->instance->frame;

    invalidate(port, checked->samples, checked->stride_bytes);
    invalidate(port, checked->confidence, checked->confidence_stride_bytes);
}

static roadpose_camera_progress_t refuse(roadpose_camera_port_t *port, roadpose_result_t reason) {
    port->is_working = false;
    port->counters.frames_refused++;
    port->counters.last_refusal = (int8_t)reason;
    release(port, &port->work);
    return ROADPOSE_CAMERA_REFUSED;
}

static roadpose_camera_progress_t finish(roadpose_camera_port_t *port) {
    roadpose_pose_t pose;
    const roadpose_result_t result = roadpose_frame_pose(port->instance, &pose);

    if (result != ROADPOSE_OK)
        return refuse(port, result);
    port->is_working = false;
    port->counters.frames_finished++;
    port->platform.pose_ready(port->platform.context, port->work.id, port->work.time_us, &pose);
    release(port, &port->work);
    return ROADPOSE_CAMERA_FINISHED;
}

roadpose_camera_progress_t roadpose_camera_task(roadpose_camera_port_t *port, uint32_t max_slices) {
    roadpose_result_t result = ROADPOSE_MORE;
    uint32_t slices;

    if (!is_ready(port))
        return ROADPOSE_CAMERA_IDLE;
    if (!port->is_working) {
        if (!take(port, &port->work))
            return ROADPOSE_CAMERA_IDLE;
        result = roadpose_frame_begin(port->instance, &port->work.frame);
        if (result != ROADPOSE_OK)
            return refuse(port, result);
        port->is_working = true;
        begin_reading(port); /* after the checks of begin, which reads no sample, and before the first slice */
        result = ROADPOSE_MORE;
    }
    for (slices = 0; slices < max_slices && result == ROADPOSE_MORE; slices++)
        result = roadpose_frame_slice(port->instance);
    if (result == ROADPOSE_MORE)
        return ROADPOSE_CAMERA_WORKING;
    return result == ROADPOSE_OK ? finish(port) : refuse(port, result);
}

void roadpose_camera_flush(roadpose_camera_port_t *port) {
    roadpose_camera_frame_t waiting;

    if (!is_ready(port))
        return;
    if (port->is_working) {
        port->is_working = false;
        (void)roadpose_frame_cancel(port->instance); /* an instance that is not running has nothing to let go of */
        port->counters.frames_flushed++;
        release(port, &port->work);
    }
    if (take(port, &waiting)) {
        port->counters.frames_flushed++;
        release(port, &waiting);
    }
}

void roadpose_camera_read_counters(const roadpose_camera_port_t *port, roadpose_camera_counters_t *counters) {
    uint32_t state;

    if (!is_ready(port) || counters == NULL)
        return;
    state = enter(port);
    *counters = port->counters;
    leave(port, state);
}
