/* The camera port between two threads: a driver that hands over as fast as it can, and a task. The lock is a mutex. */
#include <pthread.h>
#include <string.h>

#include "roadpose/camera_port.h"
#include "unity.h"

#define WIDTH 64
#define HEIGHT 64
#define BUFFERS 3
#define POSES 100u /* the driver goes on until there are as many */

struct roadpose_camera_context {
    roadpose_camera_port_t port;
    roadpose_t estimator;
    uint16_t buffers[BUFFERS][WIDTH * HEIGHT];
    pthread_mutex_t port_lock;
    pthread_mutex_t ledger_lock; /* of all below */
    uint8_t lent[BUFFERS];
    uint32_t released;
    uint32_t poses;
    uint32_t last_pose;
    uint32_t breaches; /* of the contract; Unity's assertions are for the main thread */
    uint32_t handed_over;
    bool is_over;
};

void setUp(void) {
}

void tearDown(void) {
}

static uint32_t lock(roadpose_camera_context_t *camera) {
    return (uint32_t)pthread_mutex_lock(&camera->port_lock);
}

static void unlock(roadpose_camera_context_t *camera, uint32_t state) {
    (void)state;
    (void)pthread_mutex_unlock(&camera->port_lock);
}

static void frame_release(roadpose_camera_context_t *camera, const roadpose_frame_t *frame, uint32_t frame_id) {
    (void)frame_id;
    (void)pthread_mutex_lock(&camera->ledger_lock);
    for (int i = 0; i < BUFFERS; i++)
        if (frame->samples == camera->buffers[i]) {
            camera->breaches += camera->lent[i] == 1 ? 0u : 1u;
            camera->lent[i] = 0;
        }
    camera->released++;
    (void)pthread_mutex_unlock(&camera->ledger_lock);
}

/* The time says which buffer it was; buffer 0 is blank, the others are full of disparity. */
static void pose_ready(roadpose_camera_context_t *camera, uint32_t frame_id, uint64_t time_us,
                       const roadpose_pose_t *pose) {
    const bool is_blank = time_us % BUFFERS == 0;

    (void)pthread_mutex_lock(&camera->ledger_lock);
    camera->breaches += time_us / BUFFERS == frame_id ? 0u : 1u;
    camera->breaches += (pose->valid_samples == 0) == is_blank ? 0u : 1u;
    camera->breaches += camera->poses == 0 || frame_id > camera->last_pose ? 0u : 1u;
    camera->last_pose = frame_id;
    camera->poses++;
    (void)pthread_mutex_unlock(&camera->ledger_lock);
}

/* A buffer to fill, lent from here on. While the task is between taking a frame and giving one back all may be out. */
static int borrow(roadpose_camera_context_t *camera) {
    int buffer = 0;

    (void)pthread_mutex_lock(&camera->ledger_lock);
    while (buffer < BUFFERS && camera->lent[buffer] != 0)
        buffer++;
    if (buffer < BUFFERS)
        camera->lent[buffer] = 1;
    (void)pthread_mutex_unlock(&camera->ledger_lock);
    return buffer;
}

/* True while more poses are wanted. */
static bool count_frame(roadpose_camera_context_t *camera, uint32_t handed_over) {
    (void)pthread_mutex_lock(&camera->ledger_lock);
    camera->handed_over = handed_over;
    camera->is_over = camera->poses >= POSES;
    (void)pthread_mutex_unlock(&camera->ledger_lock);
    return !camera->is_over; /* written by this thread only */
}

static void *drive(void *context) {
    roadpose_camera_context_t *camera = context;
    uint32_t id = 0;

    do {
        const int buffer = borrow(camera);
        roadpose_frame_t frame = {NULL, 2 * WIDTH, WIDTH, HEIGHT, NULL, 0};

        if (buffer == BUFFERS)
            continue;
        frame.samples = camera->buffers[buffer];
        (void)roadpose_camera_frame_ready(&camera->port, &frame, id, BUFFERS * (uint64_t)id + (uint64_t)buffer);
        id++;
    } while (count_frame(camera, id));
    return NULL;
}

static bool is_over(roadpose_camera_context_t *camera) {
    bool over;

    (void)pthread_mutex_lock(&camera->ledger_lock);
    over = camera->is_over;
    (void)pthread_mutex_unlock(&camera->ledger_lock);
    return over;
}

static void start(roadpose_camera_context_t *camera) {
    const roadpose_camera_platform_t platform = {camera, lock, unlock, frame_release, NULL, pose_ready};
    const roadpose_rig_t rig = {WIDTH, HEIGHT, 60000, 31500, 31500, 300000};
    roadpose_disparity_format_t format;

    memset(camera, 0, sizeof *camera);
    memset(&camera->buffers[1], 0x10, (BUFFERS - 1) * sizeof camera->buffers[0]);
    TEST_ASSERT_EQUAL_INT(0, pthread_mutex_init(&camera->port_lock, NULL));
    TEST_ASSERT_EQUAL_INT(0, pthread_mutex_init(&camera->ledger_lock, NULL));
    TEST_ASSERT_TRUE(roadpose_format_preset(&format, ROADPOSE_FORMAT_U16_Q8));
    TEST_ASSERT_EQUAL_INT(ROADPOSE_OK, roadpose_init(&camera->estimator, &rig, &format, NULL));
    TEST_ASSERT_EQUAL_INT(ROADPOSE_OK, roadpose_camera_init(&camera->port, &platform, &camera->estimator));
}

static void test_a_driver_and_a_task_at_the_same_time(void) {
    static roadpose_camera_context_t camera;
    roadpose_camera_counters_t counters;
    pthread_t driver;

    start(&camera);
    TEST_ASSERT_EQUAL_INT(0, pthread_create(&driver, NULL, drive, &camera));
    while (!is_over(&camera) || roadpose_camera_task(&camera.port, 2) != ROADPOSE_CAMERA_IDLE)
        (void)roadpose_camera_task(&camera.port, 2);
    TEST_ASSERT_EQUAL_INT(0, pthread_join(driver, NULL));
    roadpose_camera_read_counters(&camera.port, &counters);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(0, camera.breaches, "breaches of the contract");
    TEST_ASSERT_EQUAL_UINT32(camera.handed_over, counters.frames_ready);
    TEST_ASSERT_EQUAL_UINT32(camera.handed_over, camera.released);
    TEST_ASSERT_EQUAL_UINT32(camera.handed_over, counters.frames_displaced + counters.frames_finished);
    TEST_ASSERT_EQUAL_UINT32(camera.poses, counters.frames_finished);
    TEST_ASSERT_EQUAL_UINT32(camera.handed_over - 1, camera.last_pose); /* the newest frame is never lost */
    TEST_ASSERT_EQUAL_UINT32(0, counters.frames_refused);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_a_driver_and_a_task_at_the_same_time);
    return UNITY_END();
}
