/* heading_speed RECORDING: time of yaw from 200 tracks beside that of the disparity pipeline, frame after frame in the
 * same run. Prints Markdown; fails where the yaw takes more than a tenth. */
#define _POSIX_C_SOURCE 199309L
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "drive_simulation.h"
#include "recording_file.h"
#include "roadpose/heading.h"
#include "roadpose/tracker.h"

#define ROUNDS 301
#define TRACKS 200

static roadpose_t instance;
static roadpose_heading_t heading;
static uint8_t samples[2 * 640 * 480];
static roadpose_track_t tracks[SIMULATION_TRACKS_MAX];

static double now_us(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec * 1e6 + (double)time.tv_nsec * 1e-3;
}

static int by_value(const void *left, const void *right) {
    const double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}

static double median(double *values) {
    qsort(values, ROUNDS, sizeof *values, by_value);
    return values[ROUNDS / 2];
}

/* rate in deg/s. Returns the median share of the pipeline's time. */
static double measure(const roadpose_frame_t *frame, const char *what, double noise, double outliers, double rate_deg_s) {
    static double pipeline[ROUNDS], yaw_time[ROUNDS], share[ROUNDS];
    static simulated_tracks_t simulated;
    const simulated_mount_t mount = {0, 0, 0.02, 1.5};
    const simulated_step_t step = {1.2, radians_of(rate_deg_s / 10), noise, outliers, TRACKS};
    const int32_t down[3] = {0, 1 << 30, 0};
    random_numbers_t numbers = {7};
    roadpose_pose_t pose;
    roadpose_yaw_t yaw;
    simulate_tracks(&simulated, &SIMULATED_RIG, &mount, &step, &numbers);
    library_tracks(&simulated, &SIMULATED_RIG, tracks);
    for (int i = 0; i < ROUNDS; i++) {
        const double begin = now_us();
        roadpose_process(&instance, frame, &pose);
        const double between = now_us();
        roadpose_heading_process(&heading, tracks, TRACKS, NULL, down, &yaw);
        const double end = now_us();
        pipeline[i] = between - begin;
        yaw_time[i] = end - between;
        share[i] = yaw_time[i] / pipeline[i];
    }
    const double ratio = median(share);
    printf("| %s | %s | %.0f | %.0f | %.3f |\n", what, roadpose_yaw_status_word(yaw.status),
           median(pipeline), median(yaw_time), ratio);
    return ratio;
}

int main(int count, char *arguments[]) {
    recording_t recording;
    roadpose_rig_t rig;
    roadpose_disparity_format_t format;
    if (count != 2 || !recording_open(&recording, arguments[1]) || !recording_describe(&recording, &rig, &format)) return 2;
    if (rig.width_px != 640 || rig.height_px != 480 || !recording_read_disparity(&recording, 0, samples)) return 2;
    if (roadpose_init(&instance, &rig, &format, NULL) != ROADPOSE_OK || roadpose_heading_init(&heading, &rig, NULL) != ROADPOSE_OK)
        return 2;
    const roadpose_frame_t frame = {samples, 1280, 640, 480, NULL, 0};
    printf("| %d tracks | yaw status | pipeline, us | yaw, us | share |\n|---|---|---|---|---|\n", TRACKS);
    const double straight = measure(&frame, "straight, 0.3 px, 30 % outliers", 0.3, 0.3, 0);
    const double turning = measure(&frame, "12 deg/s, 0.3 px, 30 % outliers", 0.3, 0.3, 12);
    const double doubtful = measure(&frame, "straight, 0.5 px, 50 % outliers", 0.5, 0.5, 0);
    printf("bytes: heading %zu, tracker %zu\n", sizeof(roadpose_heading_t), sizeof(roadpose_tracker_t));
    recording_close(&recording);
    const bool cheap = straight < 0.1 && turning < 0.1 && doubtful < 0.1;
    puts(cheap ? "OK" : "FAIL: over a tenth");
    return cheap ? 0 : 1;
}
