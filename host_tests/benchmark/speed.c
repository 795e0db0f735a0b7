/* roadpose-speed RECORDING [REPEATS [LIMIT]]: time of the whole pipeline on one frame beside that of one plain v-disparity
 * histogram pass over the same buffer, in the same run. Prints Markdown. Exit status 1 when a ratio is over LIMIT. */
#define _POSIX_C_SOURCE 199309L
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "recording_file.h"
#include "roadpose/roadpose.h"

static roadpose_t instance;
static uint16_t histogram[ROADPOSE_MAX_HEIGHT][ROADPOSE_MAX_DISPARITY];
static double limit = 1e9, worst_ratio;
static volatile uint32_t sink; /* keeps the compiler from leaving work out */

static double now_us(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec * 1e6 + (double)time.tv_nsec * 1e-3;
}

/* The measure: for every valid pixel hist[row][whole disparity]++, clearing included. U16, 8 fraction bits, 0 = none. */
static void plain_pass(const uint16_t *samples, int width, int height) {
    memset(histogram, 0, sizeof histogram);
    for (int v = 0; v < height; v++) {
        uint16_t *row = histogram[v];
        for (int u = 0; u < width; u++) {
            const unsigned sample = *samples++;
            if (sample != 0 && sample < ROADPOSE_MAX_DISPARITY * 256u) row[sample >> 8]++;
        }
    }
    sink += histogram[height - 1][ROADPOSE_MAX_DISPARITY / 2];
}

static int by_value(const void *left, const void *right) {
    const double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}

static double median(double *values, int count) {
    qsort(values, (size_t)count, sizeof *values, by_value);
    return values[count / 2];
}

/* The file's big-endian samples as this machine stores them: what a camera driver would hand over. */
static void to_native(uint8_t *samples, size_t count) {
    for (size_t i = 0; i < count; i++) {
        const uint16_t sample = (uint16_t)(samples[2 * i] << 8 | samples[2 * i + 1]);
        memcpy(samples + 2 * i, &sample, sizeof sample);
    }
}

typedef struct {
    double pipeline_us, plain_us, ratio;
    roadpose_pose_t pose;
} timing_t;

static timing_t measure(const roadpose_frame_t *frame, int repeats, double *buffer) {
    timing_t timing = {0};
    double *pipeline = buffer, *plain = buffer + repeats, *ratio = plain + repeats;
    for (int i = 0; i < repeats; i++) { /* alternate, so that both see the same machine */
        const double start = now_us();
        plain_pass(frame->samples, frame->width_px, frame->height_px);
        const double middle = now_us();
        (void)roadpose_process(&instance, frame, &timing.pose);
        pipeline[i] = now_us() - middle;
        plain[i] = middle - start;
        ratio[i] = pipeline[i] / plain[i];
    }
    timing.pipeline_us = median(pipeline, repeats);
    timing.plain_us = median(plain, repeats);
    timing.ratio = median(ratio, repeats);
    return timing;
}

static int time_frame(const recording_t *recording, uint8_t *samples, int index, int repeats, double *buffer) {
    const recording_rig_t *rig = &recording->rig;
    if (!recording_read_disparity(recording, index, samples)) return 3;
    to_native(samples, (size_t)rig->width * (size_t)rig->height);
    roadpose_frame_t frame = {0};
    frame.samples = samples;
    frame.stride_bytes = 2u * (uint32_t)rig->width;
    frame.width_px = (uint16_t)rig->width;
    frame.height_px = (uint16_t)rig->height;
    const timing_t timing = measure(&frame, repeats, buffer);
    printf("| %d | %s | %.0f | %.0f | %.2f |\n", index, roadpose_status_word(timing.pose.status), timing.pipeline_us,
           timing.plain_us, timing.ratio);
    fflush(stdout);
    if (timing.ratio > worst_ratio) worst_ratio = timing.ratio;
    return 0;
}

static int time_recording(const recording_t *recording, int repeats) {
    roadpose_rig_t rig;
    roadpose_disparity_format_t format;
    if (!recording_describe(recording, &rig, &format)) return 3;
    format.byte_order = ROADPOSE_BYTES_NATIVE;
    const roadpose_result_t result = roadpose_init(&instance, &rig, &format, NULL);
    uint8_t *samples = malloc(2u * (size_t)rig.width_px * rig.height_px);
    double *buffer = malloc(3u * (size_t)repeats * sizeof *buffer);
    int failed = result == ROADPOSE_OK && samples && buffer ? 0 : 3;
    if (failed) fprintf(stderr, "roadpose-speed: roadpose_init says %d\n", (int)result);
    printf("%s, %d x %d, medians of %d runs\n\n", recording->name, rig.width_px, rig.height_px, repeats);
    printf("| frame | status | pipeline us | plain v-disparity pass us | ratio |\n|---:|---|---:|---:|---:|\n");
    const int shown = recording->frames < 5 ? recording->frames : 5;
    for (int i = 0; !failed && i < shown; i++)
        failed = time_frame(recording, samples, i * recording->frames / shown, repeats, buffer);
    printf("\nMemory of one instance: %zu bytes (%.1f KiB).\n", roadpose_state_bytes(),
           (double)roadpose_state_bytes() / 1024);
    free(buffer);
    free(samples);
    return failed;
}

int main(int argc, char **argv) {
    static recording_t recording;
    const int repeats = argc > 2 ? atoi(argv[2]) : 301;
    if (argc < 2 || repeats < 1) {
        fprintf(stderr, "usage: roadpose-speed RECORDING [REPEATS [LIMIT]]\n");
        return 2;
    }
    if (argc > 3) limit = atof(argv[3]);
    if (!recording_open(&recording, argv[1])) return 3;
    const int failed = time_recording(&recording, repeats);
    recording_close(&recording);
    if (worst_ratio > limit) fprintf(stderr, "roadpose-speed: a ratio of %.2f, at most %.2f\n", worst_ratio, limit);
    return failed ? failed : worst_ratio > limit;
}
