/* One frame of a flat road through the camera port and onto a CAN bus that prints. */
#include <stdio.h>

#include "roadpose/camera_port.h"
#include "roadpose/can.h"

#define WIDTH 640
#define HEIGHT 480
#define HORIZON 240 /* first row below it */

static uint16_t samples[HEIGHT][WIDTH];
static roadpose_t estimator;
static roadpose_camera_port_t camera_port;
static roadpose_can_transmit_t transmit;

static void take_back(roadpose_camera_context_t *camera, const roadpose_frame_t *frame, uint32_t frame_id) {
    (void)camera;
    (void)frame;
    (void)frame_id;
}

static void publish(roadpose_camera_context_t *camera, uint32_t frame_id, uint64_t time_us,
                    const roadpose_pose_t *pose) {
    roadpose_can_estimate_t estimate;
    (void)camera;
    (void)frame_id;
    printf("%s: pitch %d urad, roll %d urad, height %d um\n", roadpose_status_word(pose->status), (int)pose->pitch_urad,
           (int)pose->roll_urad, (int)pose->height_um);
    roadpose_can_estimate(&estimate, pose);
    roadpose_can_transmit_publish(&transmit, &estimate, 0, time_us);
}

static roadpose_can_send_t send(roadpose_can_context_t *can, uint32_t id, const uint8_t data[8], uint64_t deadline_us) {
    (void)can;
    (void)deadline_us;
    printf("%03X#", (unsigned)id);
    for (int i = 0; i < 8; i++) {
        printf("%02X", data[i]);
    }
    printf("\n");
    return ROADPOSE_CAN_SENT;
}

/* Baseline 0.3 m, 1.5 m over the road, level: the disparity grows by 0.3 / 1.5 pixels a row below the horizon. */
static void render_road(void) {
    for (int row = HORIZON; row < HEIGHT; row++) {
        for (int column = 0; column < WIDTH; column++) {
            samples[row][column] = (uint16_t)((2 * (row - HORIZON) + 1) * 256 / 10);
        }
    }
}

static bool start(void) {
    const roadpose_rig_t rig = {WIDTH, HEIGHT, 500000, 319500, 239500, 300000};
    const roadpose_camera_platform_t camera = {NULL, NULL, NULL, take_back, NULL, publish};
    const roadpose_can_port_t can = {NULL, send, NULL};
    roadpose_disparity_format_t format;
    return roadpose_format_preset(&format, ROADPOSE_FORMAT_U16_Q8) &&
           roadpose_state_bytes() == ROADPOSE_STATE_BYTES &&
           roadpose_init(&estimator, &rig, &format, NULL) == ROADPOSE_OK &&
           roadpose_camera_init(&camera_port, &camera, &estimator) == ROADPOSE_OK &&
           roadpose_can_transmit_init(&transmit, NULL, &can) == ROADPOSE_CAN_DONE;
}

int main(void) {
    const roadpose_frame_t frame = {samples, sizeof samples[0], WIDTH, HEIGHT, NULL, 0};
    render_road();
    if (!start() || !roadpose_camera_frame_ready(&camera_port, &frame, 0, 0)) {
        return 1;
    }
    while (roadpose_camera_task(&camera_port, 8) == ROADPOSE_CAMERA_WORKING) {
    }
    return roadpose_can_transmit_cycle(&transmit, 0) == ROADPOSE_CAN_DONE ? 0 : 1;
}
