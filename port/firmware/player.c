#include "player.h"

#include <stdio.h>

#include "board.h"
#include "can_queue.h"
#include "cost.h"
#include "csv.h"
#include "fault.h"
#include "fields.h"
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

/* What the component needs on an ECU, and all that it needs. */
typedef struct {
    roadpose_t estimator;
    roadpose_camera_port_t port;
    roadpose_can_transmit_t transmit;
    roadpose_heading_t heading;
    roadpose_camera_context_t camera;
} component_t;

static BOARD_LIBRARY_RAM component_t component;
static BOARD_EXTERNAL_RAM uint8_t samples[2 * ROADPOSE_MAX_WIDTH * ROADPOSE_MAX_HEIGHT];

/* The rest of the emulated world. */
static rig_file_t rig_file;
static recording_t recording;
static motion_t motion;
static struct roadpose_can_context can;
static cost_t cost, yaw_cost;

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

/* The cyclic task, one slice a call, until it has worked off the frame. It runs on the library's stack. */
static void run_task(void *argument) {
    roadpose_camera_progress_t *progress = argument;

    (void)board_instructions();
    do {
        *progress = roadpose_camera_task(&component.port, 1);
        cost_add_slice(&cost, board_instructions());
    } while (*progress == ROADPOSE_CAMERA_WORKING);
    cost_end_frame(&cost);
}

static bool work_off(const char *path) {
    roadpose_camera_progress_t progress;

    board_call(run_task, &progress);
    if (progress == ROADPOSE_CAMERA_FINISHED && component.camera.has_pose && !component.camera.is_lent)
        return true;
    return fault(path, "the estimator refuses the frame");
}

static void estimate_yaw(void *has_yaw) {
    *(bool *)has_yaw = motion_estimate(&motion, &component.camera.pose);
}

static bool work_off_yaw(void) {
    bool has_yaw = false;

    (void)board_instructions();
    board_call(estimate_yaw, &has_yaw);
    if (has_yaw) {
        cost_add_slice(&yaw_cost, board_instructions());
        cost_end_frame(&yaw_cost);
    }
    return has_yaw;
}

/* The CAN cycle that follows the frame. yaw NULL: the recording has no motion. */
typedef struct {
    const csv_yaw_t *yaw;
    uint64_t time_us;
    roadpose_camera_counters_t counters;
} can_cycle_t;

static void tell_bus(void *argument) {
    can_cycle_t *cycle = argument;
    roadpose_can_estimate_t estimate;

    roadpose_camera_read_counters(&component.port, &cycle->counters);
    roadpose_can_estimate(&estimate, &component.camera.pose);
    if (cycle->yaw != NULL)
        roadpose_can_estimate_yaw(&estimate, cycle->yaw->frame.yaw_urad, cycle->yaw->frame.status);
    roadpose_can_transmit_publish(&component.transmit, &estimate, cycle->counters.frames_displaced, cycle->time_us);
    (void)roadpose_can_transmit_cycle(&component.transmit, cycle->time_us); /* this bus takes everything */
}

static void tell(uint32_t index, uint64_t time_us, bool tells_fields) {
    const bool has_yaw = work_off_yaw();
    const csv_yaw_t yaw = {motion.yaw, motion.running};
    can_cycle_t cycle = {has_yaw ? &yaw : NULL, time_us, {0}};

    board_call(tell_bus, &cycle);
    can_queue_log(&can, time_us);
    csv_print_frame(stdout, index, &component.camera.pose, cycle.yaw);
    if (tells_fields)
        fields_print(&component.camera.pose, cycle.yaw, &cycle.counters);
}

static bool play_frame(uint32_t index, bool tells_fields) {
    const uint64_t time_us = index * UINT64_C(1000000000) / (uint64_t)rig_file.rate_millihz;
    static char path[PATH_BYTES]; /* too large for the stack of an ECU */

    if (!recording_frame_path(&recording, index, path) || !motion_read(&motion, &recording, index) ||
        !expose(index, time_us, path) || !work_off(path))
        return false;
    tell(index, time_us, tells_fields);
    return fflush(stdout) == 0;
}

typedef struct {
    const player_options_t *options;
    bool is_ready;
} start_t;

static void init_component(void *argument) {
    start_t *start = argument;
    const roadpose_camera_platform_t platform = {&component.camera, NULL, NULL, take_back, NULL, keep_pose};
    const roadpose_can_port_t bus = {&can, can_queue_send, NULL};
    roadpose_can_settings_t settings;

    start->is_ready =
        roadpose_init(&component.estimator, &rig_file.rig, &rig_file.format, &start->options->settings) == ROADPOSE_OK &&
        roadpose_camera_init(&component.port, &platform, &component.estimator) == ROADPOSE_OK &&
        roadpose_can_settings_default(&settings, start->options->profile) &&
        roadpose_can_transmit_init(&component.transmit, &settings, &bus) == ROADPOSE_CAN_DONE;
}

static bool set_up(const player_options_t *options) {
    static char path[PATH_BYTES];
    start_t start = {options, false};

    if (!join_path(path, options->folder, "rig.yml") || !rig_file_read(&rig_file, path) ||
        !numbered_recording_open(&recording, options->folder, options->frames) ||
        !motion_open(&motion, &component.heading, options->folder, &recording, &rig_file))
        return false;
    if (roadpose_state_bytes() != ROADPOSE_STATE_BYTES)
        return fault(NULL, "the library was built with other limits");
    board_call(init_component, &start);
    return start.is_ready || fault(path, "the estimator refuses the rig or the settings");
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
        is_good = play_frame(index, options->tells_fields);
    if (board_stack_used() >= BOARD_LIBRARY_STACK_BYTES)
        return fault(NULL, "the library's stack of %d bytes is too small", BOARD_LIBRARY_STACK_BYTES);
    return roadpose_candump_close(&can.log) && is_good;
}

void player_print_cost(void) {
    cost_print(&cost, "pose:");
    cost_print(&yaw_cost, "yaw:");
    (void)fprintf(stderr, "stack %lu\n", (unsigned long)board_stack_used());
}
