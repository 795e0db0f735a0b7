#include "player.h"

#include <stdio.h>

#include "board.h"
#include "candump.h"
#include "csv.h"
#include "fault.h"
#include "motion.h"
#include "numbered_recording.h"
#include "pgm.h"
#include "rig_file.h"
#include "roadpose/camera_port.h"
#include "roadpose/can.h"

/* The camera: one buffer that its DMA fills. */
struct roadpose_camera_context {
    bool is_lent;
    bool has_pose;
    roadpose_pose_t pose;
};

/* The CAN controller: what it sends goes to a file. */
struct roadpose_can_context {
    roadpose_candump_t log;
    uint64_t now_us;
};

/* What the component needs on an ECU, and all that it needs. */
typedef struct {
    roadpose_t estimator;
    roadpose_camera_port_t port;
    roadpose_can_transmit_t transmit;
    roadpose_camera_context_t camera;
} component_t;

static BOARD_LIBRARY_RAM component_t component;
static BOARD_EXTERNAL_RAM uint8_t samples[2 * ROADPOSE_MAX_WIDTH * ROADPOSE_MAX_HEIGHT];

/* The rest of the emulated world. */
static rig_file_t rig_file;
static recording_t recording;
static motion_t motion;
static struct roadpose_can_context can;
static cost_t cost;

static void take_back(roadpose_camera_context_t *camera, const roadpose_frame_t *frame, uint32_t frame_id) {
    (void)frame;
    (void)frame_id;
    camera->is_lent = false;
}

static void keep_pose(roadpose_camera_context_t *camera, uint32_t frame_id, uint64_t time_us,
                      const roadpose_pose_t *pose) {
    (void)frame_id;
    (void)time_us;
    camera->pose = *pose;
    camera->has_pose = true;
}

static roadpose_can_send_t send(roadpose_can_context_t *bus, uint32_t id, const uint8_t data[8], uint64_t deadline_us) {
    (void)deadline_us;
    roadpose_candump_write(&bus->log, bus->now_us, id, data);
    return ROADPOSE_CAN_SENT;
}

/* The driver's interrupt: a frame is complete. */
static bool expose(uint32_t index, uint64_t time_us, const char *path) {
    const roadpose_rig_t *rig = &rig_file.rig;
    const roadpose_frame_t frame = {samples, 2u * rig->width_px, rig->width_px, rig->height_px, NULL, 0};

    if (rig_file.is_rescaled)
        return fault(path, "the firmware plays no recording whose disparity_scale is not a power of two");
    if (!pgm_read(samples, rig->width_px, rig->height_px, path))
        return false;
    component.camera.has_pose = false;
    component.camera.is_lent = roadpose_camera_frame_ready(&component.port, &frame, index, time_us);
    return component.camera.is_lent || fault(path, "the camera port does not take the frame");
}

/* The cyclic task, one slice a call, until it has worked off the frame. */
static bool work_off(const char *path) {
    roadpose_camera_progress_t progress = ROADPOSE_CAMERA_WORKING;

    (void)board_instructions();
    while (progress == ROADPOSE_CAMERA_WORKING) {
        progress = roadpose_camera_task(&component.port, 1);
        cost_add_slice(&cost, board_instructions());
    }
    cost_end_frame(&cost);
    if (progress == ROADPOSE_CAMERA_FINISHED && component.camera.has_pose && !component.camera.is_lent)
        return true;
    return fault(path, "the estimator refuses the frame");
}

/* The CAN cycle that follows the frame. yaw NULL: the recording has no motion. */
static void tell_bus(const csv_yaw_t *yaw, uint64_t time_us) {
    roadpose_can_estimate_t estimate;
    roadpose_camera_counters_t counters;

    roadpose_camera_read_counters(&component.port, &counters);
    roadpose_can_estimate(&estimate, &component.camera.pose);
    if (yaw != NULL)
        roadpose_can_estimate_yaw(&estimate, yaw->frame.yaw_urad, yaw->frame.status);
    roadpose_can_transmit_publish(&component.transmit, &estimate, counters.frames_displaced, time_us);
    can.now_us = time_us;
    (void)roadpose_can_transmit_cycle(&component.transmit, time_us); /* this bus takes everything */
}

static void tell(uint32_t index, uint64_t time_us) {
    const bool has_yaw = motion_estimate(&motion, &component.camera.pose);
    const csv_yaw_t yaw = {motion.yaw, motion.running};

    csv_print_frame(stdout, index, &component.camera.pose, has_yaw ? &yaw : NULL);
    tell_bus(has_yaw ? &yaw : NULL, time_us);
}

static bool play_frame(uint32_t index) {
    const uint64_t time_us = index * UINT64_C(1000000000) / (uint64_t)rig_file.rate_millihz;
    static char path[PATH_BYTES]; /* too large for the stack of an ECU */

    if (!recording_frame_path(&recording, index, path) || !motion_read(&motion, &recording, index) ||
        !expose(index, time_us, path) || !work_off(path))
        return false;
    tell(index, time_us);
    return fflush(stdout) == 0;
}

static bool init_component(const player_options_t *options) {
    const roadpose_camera_platform_t platform = {&component.camera, NULL, NULL, take_back, NULL, keep_pose};
    const roadpose_can_port_t bus = {&can, send, NULL};
    roadpose_can_settings_t settings;

    return roadpose_init(&component.estimator, &rig_file.rig, &rig_file.format, &options->settings) == ROADPOSE_OK &&
           roadpose_camera_init(&component.port, &platform, &component.estimator) == ROADPOSE_OK &&
           roadpose_can_settings_default(&settings, options->profile) &&
           roadpose_can_transmit_init(&component.transmit, &settings, &bus) == ROADPOSE_CAN_DONE;
}

static bool set_up(const player_options_t *options) {
    static char path[PATH_BYTES];

    if (!join_path(path, options->folder, "rig.yml") || !rig_file_read(&rig_file, path) ||
        !numbered_recording_open(&recording, options->folder, options->frames) ||
        !motion_open(&motion, options->folder, &recording, &rig_file))
        return false;
    if (roadpose_state_bytes() != ROADPOSE_STATE_BYTES)
        return fault(NULL, "the library was built with other limits");
    return init_component(options) || fault(path, "the estimator refuses the rig or the settings");
}

bool player_play(const player_options_t *options) {
    bool is_good = set_up(options);
    uint32_t index;

    if (!is_good)
        return false;
    if (!roadpose_candump_open(&can.log, options->can_log, "can0"))
        return fault(options->can_log, "cannot be written");
    csv_print_header(stdout);
    for (index = 0; is_good && index < options->frames; index++)
        is_good = play_frame(index);
    return roadpose_candump_close(&can.log) && is_good;
}

const cost_t *player_cost(void) {
    return &cost;
}
