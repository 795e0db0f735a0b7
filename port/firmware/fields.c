#include "fields.h"

#include <inttypes.h>
#include <stdio.h>

static void print_all(const int64_t *values, size_t count) {
    size_t i;

    for (i = 0; i < count; i++)
        printf(" %" PRId64, values[i]);
}

static void print_pose(const roadpose_pose_t *p) {
    const int64_t values[] = {
        p->status, p->observed, p->pitch_urad, p->roll_urad, p->height_um, p->paper_pitch_urad, p->paper_roll_urad,
        p->normal_q30[0], p->normal_q30[1], p->normal_q30[2], p->plane_u_q24, p->plane_v_q24, p->plane_0_q16,
        p->valid_samples, p->free_samples, p->road_points, p->support_permille, p->residual_millipx, p->range_near_mm,
        p->range_far_mm};

    printf("pose");
    print_all(values, sizeof values / sizeof values[0]);
}

static void print_yaw(const roadpose_yaw_t *y) {
    const int64_t values[] = {
        y->status, y->yaw_urad, y->sigma_urad, y->pitch_motion_urad, y->pitch_difference_urad, y->focus_u_q8,
        y->focus_v_q8, y->yaw_rate_urad_s, y->yaw_rate_sigma_urad_s, y->tracks_used, y->tracks_moving,
        y->tracks_agreeing, y->noise_millipx, y->dropped_outside, y->dropped_limit};

    printf(" yaw");
    print_all(values, sizeof values / sizeof values[0]);
}

static void print_running(const roadpose_running_yaw_t *r) {
    const int64_t values[] = {r->yaw_urad, r->spread_urad, r->count, r->accepted};
    unsigned status;

    printf(" running");
    print_all(values, sizeof values / sizeof values[0]);
    for (status = 0; status < ROADPOSE_YAW_STATUS_COUNT; status++)
        printf(" %" PRIu32, r->refused[status]);
}

static void print_counters(const roadpose_camera_counters_t *c) {
    const int64_t values[] = {c->frames_ready,   c->frames_displaced, c->frames_finished,
                              c->frames_refused, c->frames_flushed,   c->last_refusal};

    printf(" frames");
    print_all(values, sizeof values / sizeof values[0]);
}

void fields_print(const roadpose_pose_t *pose, const csv_yaw_t *yaw, const roadpose_camera_counters_t *counters) {
    print_pose(pose);
    if (yaw != NULL) {
        print_yaw(&yaw->frame);
        print_running(&yaw->running);
    }
    print_counters(counters);
    printf("\n");
}
