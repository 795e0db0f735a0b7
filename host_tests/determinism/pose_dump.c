/* pose_dump RECORDING: every field of every pose, and a checksum of the map and histogram, for comparison. */
#include <stdio.h>
#include <stdlib.h>

#include "recording_file.h"
#include "roadpose/roadpose.h"
#include "synthetic.h"

static roadpose_t instance;
static recording_t recording;

static void print_pose(const roadpose_pose_t *pose) {
    printf("%s %u %ld %ld %ld %ld %ld", roadpose_status_word(pose->status), pose->observed, (long)pose->pitch_urad,
           (long)pose->roll_urad, (long)pose->height_um, (long)pose->paper_pitch_urad, (long)pose->paper_roll_urad);
    printf(" %ld %ld %ld", (long)pose->normal_q30[0], (long)pose->normal_q30[1], (long)pose->normal_q30[2]);
    printf(" %ld %ld %ld", (long)pose->plane_u_q24, (long)pose->plane_v_q24, (long)pose->plane_0_q16);
    printf(" %lu %lu %lu", (unsigned long)pose->valid_samples, (unsigned long)pose->free_samples,
           (unsigned long)pose->road_points);
    printf(" %u %u %lu %lu", pose->support_permille, pose->residual_millipx, (unsigned long)pose->range_near_mm,
           (unsigned long)pose->range_far_mm);
}

static void print_checksum(void) {
    uint32_t sum = 0;
    for (uint16_t d = 0; d < 128; d++) {
        for (uint16_t i = 0; i < 160; i++) sum = sum * 31 + roadpose_is_free(&instance, i, d);
        for (uint16_t j = 0; j < 240; j++) sum = sum * 31 + roadpose_v_disparity_free(&instance, j, d);
    }
    printf(" %08lx\n", (unsigned long)sum);
}

static bool dump_frame(const roadpose_rig_t *rig, uint8_t *samples, int index) {
    const roadpose_frame_t frame = frame_of(rig, samples);
    roadpose_pose_t pose;
    if (!recording_read_disparity(&recording, index, samples)) return false;
    if (roadpose_process(&instance, &frame, &pose) != ROADPOSE_OK) return false;
    print_pose(&pose);
    print_checksum();
    return true;
}

int main(int argc, char **argv) {
    roadpose_rig_t rig;
    roadpose_disparity_format_t format;
    if (argc != 2 || !recording_open(&recording, argv[1]) || !recording_describe(&recording, &rig, &format)) return 2;
    if (roadpose_init(&instance, &rig, &format, NULL) != ROADPOSE_OK) return 1;
    uint8_t *samples = malloc(2u * (size_t)rig.width_px * rig.height_px);
    bool ok = samples != NULL;
    for (int i = 0; ok && i < recording.frames; i++) ok = dump_frame(&rig, samples, i);
    free(samples);
    recording_close(&recording);
    return ok ? 0 : 1;
}
