/* roadpose-listen: what an ECU on the bus sees. Reads a log of can-utils, checks and unpacks our frames with the
 * receiver of port/can, and prints a line for each cycle. candump -L can0 | roadpose-listen          roadpose-listen
 * drive.log */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "candump.h"
#include "roadpose/can.h"

#define LINE_BYTES 256

static const char usage[] = "usage: roadpose-listen [--profile 1|2|5] [FILE]\n"
                            "Decodes roadpose frames in a log of can-utils (candump -L) from FILE or standard input.\n"
                            "Empty columns: not observed. e2e: pose/quality/status.\n";

static const char header[] = "time_s,status,pitch_deg,roll_deg,height_m,yaw_deg,support_percent,residual_px,"
                             "range_near_m,range_far_m,frame_count,refused_count,overwritten_count,dropped_count,e2e";

static void print_number(unsigned valid, double value, int decimals) {
    if (valid != 0u)
        printf(",%.*f", decimals, value);
    else
        printf(",");
}

static double degrees(int32_t urad) {
    return (double)urad * 180e-6 / 3.14159265358979323846;
}

static void print_pose(const roadpose_can_pose_t *pose) {
    print_number(pose->valid & ROADPOSE_CAN_PITCH, degrees(pose->pitch_urad), 3);
    print_number(pose->valid & ROADPOSE_CAN_ROLL, degrees(pose->roll_urad), 3);
    print_number(pose->valid & ROADPOSE_CAN_HEIGHT, (double)pose->height_um * 1e-6, 5);
}

static void print_quality(const roadpose_can_quality_t *quality) {
    print_number(quality->valid & ROADPOSE_CAN_YAW, degrees(quality->yaw_urad), 2);
    print_number(quality->valid & ROADPOSE_CAN_SUPPORT, quality->support_permille / 10.0, 0);
    print_number(quality->valid & ROADPOSE_CAN_RESIDUAL, quality->residual_millipx / 1000.0, 3);
    print_number(quality->valid & ROADPOSE_CAN_RANGE_NEAR, quality->range_near_mm / 1000.0, 1);
    print_number(quality->valid & ROADPOSE_CAN_RANGE_FAR, quality->range_far_mm / 1000.0, 0);
}

static void print_counts(const roadpose_can_status_t *status) {
    print_number(status->valid & ROADPOSE_CAN_FRAME_COUNT, status->frame_count, 0);
    print_number(status->valid & ROADPOSE_CAN_REFUSED_COUNT, status->refused_count, 0);
    print_number(status->valid & ROADPOSE_CAN_OVERWRITTEN_COUNT, status->overwritten_count, 0);
    print_number(status->valid & ROADPOSE_CAN_DROPPED_COUNT, status->dropped_count, 0);
}

static const char *e2e_word(const roadpose_can_view_t *view, roadpose_can_message_t message) {
    return roadpose_e2e_status_word((roadpose_e2e_status_t)view->e2e[message]);
}

static void print_view(uint64_t time_us, const roadpose_can_view_t *view) {
    printf("%" PRIu64 ".%06" PRIu64 ",%s", time_us / 1000000u, time_us % 1000000u,
           roadpose_can_status_word(view->status.pose_status));
    print_pose(&view->pose);
    print_quality(&view->quality);
    print_counts(&view->status);
    printf(",%s/%s/%s\n", e2e_word(view, ROADPOSE_CAN_MESSAGE_POSE), e2e_word(view, ROADPOSE_CAN_MESSAGE_QUALITY),
           e2e_word(view, ROADPOSE_CAN_MESSAGE_STATUS));
    (void)fflush(stdout);
}

/* The cycles in which nothing came, by the log's times: the receiver must know of them. */
static void pass_silence(roadpose_can_receive_t *receive, uint64_t last_us, uint64_t time_us) {
    const uint64_t cycle_us = receive->settings.cycle_us;
    uint64_t silent = (time_us > last_us) ? (time_us - last_us + cycle_us / 2u) / cycle_us : 0u;
    silent = (silent > UINT8_MAX) ? UINT8_MAX : silent; /* beyond that the receiver knows no more than "long" */
    for (uint64_t cycle = 1; cycle < silent; cycle++)
        roadpose_can_receive_cycle(receive);
}

/* The status is the last frame of a cycle. */
static void listen_to(FILE *file, roadpose_can_receive_t *receive) {
    char line[LINE_BYTES];
    roadpose_candump_frame_t frame;
    uint64_t last_us = UINT64_MAX;
    puts(header);
    while (fgets(line, sizeof line, file) != NULL) {
        if (!roadpose_candump_parse(line, &frame))
            continue;
        pass_silence(receive, last_us, frame.time_us);
        const roadpose_can_message_t message = roadpose_can_receive_frame(receive, frame.id, frame.data, frame.length);
        if (message != ROADPOSE_CAN_MESSAGE_NONE)
            last_us = frame.time_us;
        if (message == ROADPOSE_CAN_MESSAGE_STATUS) {
            print_view(frame.time_us, &receive->view);
            roadpose_can_receive_cycle(receive);
        }
    }
}

/* Returns the index of FILE among the arguments, or 0 when they cannot be understood. */
static int read_arguments(int count, char *const arguments[], roadpose_can_settings_t *settings) {
    int next = 1;
    int profile = ROADPOSE_E2E_PROFILE_1;
    if (count > 2 && strcmp(arguments[1], "--profile") == 0) {
        profile = atoi(arguments[2]);
        next = 3;
    }
    const bool understood = roadpose_can_settings_default(settings, (roadpose_e2e_profile_t)profile) &&
                            (next == count || (next + 1 == count && arguments[next][0] != '-'));
    return understood ? next : 0;
}

int main(int count, char *arguments[]) {
    roadpose_can_settings_t settings;
    roadpose_can_receive_t receive;
    const int next = read_arguments(count, arguments, &settings);
    if (next == 0) {
        (void)fputs(usage, stderr);
        return 2;
    }
    FILE *const file = (next < count) ? fopen(arguments[next], "r") : stdin;
    if (file == NULL) {
        perror(arguments[next]);
        return 3;
    }
    (void)roadpose_can_receive_init(&receive, &settings);
    listen_to(file, &receive);
    if (file != stdin)
        (void)fclose(file);
    return 0;
}
