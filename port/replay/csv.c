#include "csv.h"

#include <inttypes.h>
#include <stdbool.h>

#include "decimal.h"
#include "roadpose/roadpose.h"

/* 180 / pi to 2e-18 of itself: a convergent of its continued fraction. */
#define DEGREE_NUMERATOR INT64_C(1204537366)
#define DEGREE_DENOMINATOR INT64_C(21023143)

/* Millionths of a degree, rounded half away from zero. |urad| * numerator < 2^31 * 2^30.2 < 2^62. */
static int64_t microdegrees(int32_t urad) {
    const int64_t half = urad < 0 ? -(DEGREE_DENOMINATOR / 2) : DEGREE_DENOMINATOR / 2;

    return (urad * DEGREE_NUMERATOR + half) / DEGREE_DENOMINATOR;
}

static void print_number(FILE *csv, bool is_known, int64_t scaled, int places) {
    char text[DECIMAL_TEXT_BYTES] = "";

    if (is_known)
        decimal_print(text, scaled, places);
    (void)fprintf(csv, ",%s", text);
}

void csv_print_header(FILE *csv) {
    (void)fputs("frame,status,pitch_deg,roll_deg,height_m,yaw_deg,paper_pitch_deg,paper_roll_deg,"
                "road_points,support_permille,residual_px,range_near_m,range_far_m,"
                "yaw_status,yaw_sigma_deg,running_yaw_deg,running_spread_deg,running_frames,pitch_motion_deg,"
                "pitch_difference_deg,yaw_rate_deg_s,tracks_agreeing\n",
                csv);
}

static void print_support(FILE *csv, bool is_known, const roadpose_pose_t *pose) {
    print_number(csv, is_known, pose->road_points, 0);
    print_number(csv, is_known, pose->support_permille, 0);
    print_number(csv, is_known, pose->residual_millipx, 3);
    print_number(csv, is_known, pose->range_near_mm, 3);
    print_number(csv, is_known, pose->range_far_mm, 3);
}

/* pitch of the road plane = pitch of motion + pitch difference */
static void print_yaw(FILE *csv, const csv_yaw_t *yaw) {
    static const csv_yaw_t nothing;
    const csv_yaw_t *y = yaw != NULL ? yaw : &nothing;
    const bool is_yaw = yaw != NULL && y->frame.status == ROADPOSE_YAW_OK;
    const bool is_running = y->running.count > 0;

    (void)fprintf(csv, ",%s", yaw != NULL ? roadpose_yaw_status_word(y->frame.status) : "");
    print_number(csv, is_yaw, microdegrees(y->frame.sigma_urad), 6);
    print_number(csv, is_running, microdegrees(y->running.yaw_urad), 6);
    print_number(csv, is_running, microdegrees(y->running.spread_urad), 6);
    print_number(csv, yaw != NULL, y->running.count, 0);
    print_number(csv, is_yaw, microdegrees(y->frame.pitch_motion_urad), 6);
    print_number(csv, is_yaw, microdegrees(y->frame.pitch_difference_urad), 6);
    print_number(csv, y->frame.tracks_agreeing > 0, microdegrees(y->frame.yaw_rate_urad_s), 6);
    print_number(csv, yaw != NULL, y->frame.tracks_agreeing, 0);
}

void csv_print_frame(FILE *csv, uint32_t frame, const roadpose_pose_t *pose, const csv_yaw_t *yaw) {
    const bool is_pose = pose->status == ROADPOSE_STATUS_OK;
    const bool has_pitch = is_pose && (pose->observed & ROADPOSE_OBSERVED_PITCH) != 0;
    const bool has_roll = is_pose && (pose->observed & ROADPOSE_OBSERVED_ROLL) != 0;
    const bool has_height = is_pose && (pose->observed & ROADPOSE_OBSERVED_HEIGHT) != 0;

    (void)fprintf(csv, "%" PRIu32 ",%s", frame, roadpose_status_word(pose->status));
    print_number(csv, has_pitch, microdegrees(pose->pitch_urad), 6);
    print_number(csv, has_roll, microdegrees(pose->roll_urad), 6);
    print_number(csv, has_height, pose->height_um, 6);
    print_number(csv, yaw != NULL && yaw->frame.status == ROADPOSE_YAW_OK,
                 yaw != NULL ? microdegrees(yaw->frame.yaw_urad) : 0, 6);
    print_number(csv, has_pitch, microdegrees(pose->paper_pitch_urad), 6);
    print_number(csv, has_roll, microdegrees(pose->paper_roll_urad), 6);
    print_support(csv, is_pose, pose);
    print_yaw(csv, yaw);
    (void)fputc('\n', csv);
}

void csv_print_pose(FILE *csv, uint32_t frame, const roadpose_pose_t *pose) {
    csv_print_frame(csv, frame, pose, NULL);
}
