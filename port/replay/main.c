/* roadpose-replay: plays a recording through the camera port, as a camera driver and a cyclic task would use it. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "can_bus.h"
#include "csv.h"
#include "fault.h"
#include "motion.h"
#include "options.h"
#include "pace.h"
#include "pgm.h"
#include "pictures.h"
#include "recording.h"
#include "rig_file.h"
#include "roadpose/camera_port.h"

#define SLICES_PER_CYCLE 16u /* any number gives the same poses */

/* The camera of the recording and the listener to its poses. */
struct roadpose_camera_context {
    uint8_t samples[2 * ROADPOSE_MAX_WIDTH * ROADPOSE_MAX_HEIGHT]; /* the driver's one buffer */
    bool is_lent;                                                  /* to the port */
    bool prints;                                                   /* the poses, on standard output */
    can_bus_t can;
    motion_t motion;
    roadpose_heading_t heading;
};

typedef struct {
    options_t options;
    rig_file_t rig_file;
    recording_t recording;
    roadpose_t estimator;
    roadpose_camera_port_t port;
    roadpose_camera_context_t camera;
} replay_t;

static void take_back(roadpose_camera_context_t *camera, const roadpose_frame_t *frame, uint32_t frame_id) {
    (void)frame;
    (void)frame_id;
    camera->is_lent = false;
}

static void print_pose(roadpose_camera_context_t *camera, uint32_t frame_id, uint64_t time_us,
                       const roadpose_pose_t *pose) {
    const bool has_yaw = motion_estimate(&camera->motion, pose);
    const csv_yaw_t yaw = {camera->motion.yaw, camera->motion.running};

    (void)time_us;
    if (camera->prints) {
        progress_clear(); /* both may be the same terminal */
        csv_print_frame(stdout, frame_id, pose, has_yaw ? &yaw : NULL);
    }
    can_bus_pose(&camera->can, pose);
    if (has_yaw)
        can_bus_yaw(&camera->can, yaw.frame.yaw_urad, yaw.frame.status);
}

static void rescale(uint8_t *samples, const rig_file_t *rig_file) {
    uint8_t *const end = samples + (size_t)2 * rig_file->rig.width_px * rig_file->rig.height_px;

    for (; samples < end; samples += 2) {
        const uint16_t sample = rig_file_rescale(rig_file, (uint16_t)(samples[0] << 8 | samples[1]));

        samples[0] = (uint8_t)(sample >> 8);
        samples[1] = (uint8_t)(sample & 0xffu);
    }
}

static uint64_t frame_time_us(const replay_t *replay, size_t index) {
    return (uint64_t)index * UINT64_C(1000000000) / (uint64_t)replay->rig_file.rate_millihz;
}

/* What a driver's interrupt does when its buffer is full: the path is only for the fault. */
static bool expose(replay_t *replay, size_t index, const char *path) {
    const roadpose_rig_t *rig = &replay->rig_file.rig;
    const uint64_t time_us = frame_time_us(replay, index);
    roadpose_frame_t frame = {replay->camera.samples, 2u * rig->width_px, rig->width_px, rig->height_px, NULL, 0};

    if (!pgm_read(replay->camera.samples, rig->width_px, rig->height_px, path))
        return false;
    if (replay->rig_file.is_rescaled)
        rescale(replay->camera.samples, &replay->rig_file);
    replay->camera.is_lent =
        roadpose_camera_frame_ready(&replay->port, &frame, recording_frame_number(&replay->recording, index), time_us);
    return replay->camera.is_lent || fault(path, "the camera port does not take the frame");
}

/* The cyclic task, called until it has worked off the frame. */
static bool work_off(replay_t *replay, const char *path) {
    roadpose_camera_progress_t progress = ROADPOSE_CAMERA_WORKING;
    roadpose_camera_counters_t counters;

    while (progress == ROADPOSE_CAMERA_WORKING)
        progress = roadpose_camera_task(&replay->port, SLICES_PER_CYCLE);
    if (progress == ROADPOSE_CAMERA_FINISHED && !replay->camera.is_lent)
        return true;
    roadpose_camera_read_counters(&replay->port, &counters);
    return fault(path, "the estimator refuses the frame (result %d)", counters.last_refusal);
}

/* An overlay of the frame that was worked off last. */
static bool draw(const replay_t *replay, const char *path) {
    const picture_t picture = {replay->options.pictures_folder, replay->options.recording, path, replay->camera.samples,
                               &replay->rig_file.rig, &replay->rig_file.format, &replay->estimator};

    return picture.folder == NULL || pictures_draw(&picture);
}

/* A CAN cycle, and what is left of the time until the next frame. */
static void send_and_wait(replay_t *replay, const pace_t *pace, size_t index) {
    const uint64_t time_us = frame_time_us(replay, index);
    const uint64_t next_us = frame_time_us(replay, index + 1u);
    const bool is_last = index + 1u == replay->recording.count;
    bool is_pending = can_bus_cycle(&replay->camera.can, time_us);
    uint64_t now_us;

    while (pace_wait(pace, time_us, next_us, is_last, is_pending, &now_us))
        is_pending = can_bus_poll(&replay->camera.can, now_us);
}

static int play(replay_t *replay) {
    const size_t count = replay->recording.count;
    char path[PATH_BYTES];
    pace_t pace;
    size_t index;

    pace_begin(&pace, replay->options.speed_permille);
    if (replay->camera.prints)
        csv_print_header(stdout);
    for (index = 0; index < count; index++) {
        pace_frame(&pace);
        if (!recording_frame_path(&replay->recording, index, path) ||
            !motion_read(&replay->camera.motion, &replay->recording, index) || !expose(replay, index, path) ||
            !work_off(replay, path))
            return EXIT_BAD_RECORDING;
        if (!draw(replay, path))
            return EXIT_FAILURE;
        if (fflush(stdout) != 0) {
            (void)fault("standard output", "cannot be written: %s", strerror(errno));
            return EXIT_FAILURE;
        }
        send_and_wait(replay, &pace, index);
        progress_show(index + 1, count);
    }
    progress_clear();
    return EXIT_SUCCESS;
}

static bool set_up(replay_t *replay) {
    const roadpose_camera_platform_t platform = {&replay->camera, NULL, NULL, take_back, NULL, print_pose};
    char path[PATH_BYTES];
    roadpose_result_t result;

    if (!join_path(path, replay->options.recording, "rig.yml") || !rig_file_read(&replay->rig_file, path))
        return false;
    if (!recording_open(&replay->recording, replay->options.recording) ||
        !motion_open(&replay->camera.motion, &replay->camera.heading, replay->options.recording, &replay->recording,
                     &replay->rig_file))
        return false;
    result =
        roadpose_init(&replay->estimator, &replay->rig_file.rig, &replay->rig_file.format, &replay->options.settings);
    if (result == ROADPOSE_OK)
        result = roadpose_camera_init(&replay->port, &platform, &replay->estimator);
    return result == ROADPOSE_OK || fault(path, "the estimator refuses the rig (result %d)", (int)result);
}

/* The bus is opened last: whoever listens hears nothing of a recording that cannot be played. */
static int play_on_bus(replay_t *replay) {
    int status = EXIT_FAILURE;

    replay->camera.prints = replay->options.candump_path == NULL || strcmp(replay->options.candump_path, "-") != 0;
    if (can_bus_open(&replay->camera.can, &replay->options, frame_time_us(replay, 1)))
        status = play(replay);
    return can_bus_close(&replay->camera.can) ? status : EXIT_FAILURE;
}

int main(int count, char *arguments[]) {
    static replay_t replay; /* too large for a stack */
    int status = EXIT_BAD_RECORDING;

    switch (options_parse(&replay.options, count, arguments)) {
    case OPTIONS_HELP:
        return fflush(stdout) == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
    case OPTIONS_BAD:
        return EXIT_BAD_ARGUMENTS;
    case OPTIONS_PLAY:
        if (!pictures_open(replay.options.pictures_folder))
            return EXIT_BAD_ARGUMENTS;
        break;
    }
    if (set_up(&replay))
        status = play_on_bus(&replay);
    motion_close(&replay.camera.motion);
    recording_close(&replay.recording);
    return status;
}
