/* A camera driver for the tests of the camera port: three buffers, an interrupt that may strike at every point where
 * the port calls out, and a ledger that knows who owns which frame. Every breach of the contract fails the test. */
#ifndef ROADPOSE_TEST_CAMERA_DRIVER_H
#define ROADPOSE_TEST_CAMERA_DRIVER_H

#include "roadpose/camera_port.h"

#define DRIVER_WIDTH 64
#define DRIVER_HEIGHT 64
#define DRIVER_SAMPLES (DRIVER_WIDTH * DRIVER_HEIGHT)
#define DRIVER_BUFFERS 3
#define DRIVER_FRAMES 4096 /* in the ledger */
#define DRIVER_SCENES 3    /* frame n shows scene n % 3 */
#define DRIVER_NEVER UINT32_MAX

/* What the driver hands over. */
typedef enum { FRAME_GOOD, FRAME_WRONG_SIZE, FRAME_SHORT_STRIDE, FRAME_WITHOUT_SAMPLES, FRAME_KINDS } frame_kind_t;

typedef enum { OWNER_NOBODY = 0, OWNER_PORT, OWNER_DRIVER_AGAIN } frame_owner_t;

struct roadpose_camera_context {
    roadpose_camera_port_t port;
    roadpose_t estimator;
    uint16_t buffers[DRIVER_BUFFERS][DRIVER_SAMPLES];
    bool is_lent[DRIVER_BUFFERS];
    unsigned filling; /* the buffer that the camera writes to */
    uint32_t next_frame;
    uint8_t owner[DRIVER_FRAMES];  /* frame_owner_t */
    uint8_t buffer[DRIVER_FRAMES]; /* where the frame is */
    uint8_t kind[DRIVER_FRAMES];   /* frame_kind_t */
    uint32_t poses;
    uint32_t last_pose_frame;
    roadpose_pose_t last_pose;
    uint32_t invalidations; /* calls of cache_invalidate */
    const void *invalidated[2];
    size_t invalidated_bytes[2];
    volatile int lock_depth;
    volatile bool is_in_interrupt;
    uint32_t point;     /* interrupt points passed so far */
    uint32_t strike[2]; /* points at which an interrupt strikes */
    frame_kind_t strike_kind;
};

/* Starts estimator, driver and port: buffers all the driver's, no interrupt to come. */
void driver_start(roadpose_camera_context_t *driver);

/* The platform that driver_start() uses: all callbacks. */
roadpose_camera_platform_t driver_platform(roadpose_camera_context_t *driver);

/* The interrupt: hands over the buffer that is full, and takes the next one to fill. */
void driver_interrupt(roadpose_camera_context_t *driver, frame_kind_t kind);

/* A point between two calls where an interrupt may strike. */
void driver_pass_point(roadpose_camera_context_t *driver);

/* Flushes the port, then fails unless every frame came back and the counters add up. */
void driver_stop(roadpose_camera_context_t *driver);

/* What the frame shows, DRIVER_SAMPLES samples. */
void driver_draw(uint16_t *samples, uint32_t frame);

/* The pose that a whole-frame call gives for a scene. */
roadpose_pose_t driver_expected_pose(uint32_t frame);

#endif
