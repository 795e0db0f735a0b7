/* roadpose-listen: what an ECU on the bus sees. Reads a log of can-utils, checks and unpacks our frames with the
 * receiver of port/can, and prints a line for each cycle in which one of them came:
 *     candump -L can0 | roadpose-listen
 *     roadpose-listen drive.log
 */
#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "candump.h"
#include "roadpose/can.h"

#define LINE_BYTES 256

static const char usage[] = "usage: roadpose-listen [--profile 1|2|5] [FILE]\n"
                            "Decodes roadpose frames in a log of can-utils (candump -L) from FILE or standard input.\n"
                            "Empty columns: not observed. e2e: pose/quality/status.\n"
                            "Exit status: 0 read to the end, 1 output cannot be written, 2 bad arguments, 3 FILE cannot "
                            "be read.\n";

/* The receiver, and where it stands in the running cycle. */
typedef struct {
    roadpose_can_receive_t receive;
    bool has_cycle;      /* a frame has come in it */
    uint32_t last;       /* the message that came last */
    uint64_t last_us;    /* when; UINT64_MAX: none yet */
} listener_t;

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
    (void)fflush(stdout); /* a failure is kept, and told at the end */
}

static uint32_t message_of(const listener_t *listener, uint32_t id) {
    uint32_t message = 0;
    while (message < ROADPOSE_CAN_MESSAGES && listener->receive.settings.id[message] != id)
        message++;
    return message;
}

static void end_cycle(listener_t *listener) {
    if (!listener->has_cycle)
        return;
    roadpose_can_receive_cycle(&listener->receive); /* first: it notes what did not come */
    print_view(listener->last_us, &listener->receive.view);
    listener->has_cycle = false;
}

/* The cycles in which nothing came, by the log's times: the receiver must know of them. */
static void pass_silence(listener_t *listener, uint64_t time_us) {
    const uint64_t cycle_us = listener->receive.settings.cycle_us;
    const uint64_t past_us = (time_us > listener->last_us) ? time_us - listener->last_us : 0u;
    uint64_t silent = past_us / cycle_us + (past_us % cycle_us >= cycle_us / 2u ? 1u : 0u);
    silent = (silent > UINT8_MAX) ? UINT8_MAX : silent; /* beyond that the receiver knows no more than "long" */
    for (uint64_t cycle = 1; cycle < silent; cycle++)
        roadpose_can_receive_cycle(&listener->receive);
}

/* A cycle ends with its status. One whose status was lost ends with the first frame that belongs to the next. */
static void hear(listener_t *listener, const roadpose_candump_frame_t *frame) {
    const uint32_t message = message_of(listener, frame->id);
    if (message == ROADPOSE_CAN_MESSAGES)
        return;
    if (message <= listener->last)
        end_cycle(listener);
    if (!listener->has_cycle)
        pass_silence(listener, frame->time_us);
    (void)roadpose_can_receive_frame(&listener->receive, frame->id, frame->data, frame->length);
    listener->has_cycle = true;
    listener->last = message;
    listener->last_us = frame->time_us;
    if (message == ROADPOSE_CAN_MESSAGE_STATUS)
        end_cycle(listener);
}

/* Returns false when the file cannot be read. */
static bool listen_to(FILE *file, listener_t *listener) {
    char line[LINE_BYTES];
    roadpose_candump_frame_t frame;
    puts(header);
    while (fgets(line, sizeof line, file) != NULL)
        if (roadpose_candump_parse(line, &frame))
            hear(listener, &frame);
    end_cycle(listener);
    return ferror(file) == 0;
}

/* A digit, nothing else; 0 for anything that is none. */
static roadpose_e2e_profile_t read_profile(const char *text) {
    const bool is_digit = text[0] >= '1' && text[0] <= '9' && text[1] == '\0';
    return (roadpose_e2e_profile_t)(is_digit ? text[0] - '0' : 0);
}

/* Returns the index of FILE among the arguments, or 0 when they cannot be understood. */
static int read_arguments(int count, char *const arguments[], roadpose_can_settings_t *settings) {
    int next = 1;
    roadpose_e2e_profile_t profile = ROADPOSE_E2E_PROFILE_1;
    if (count > 2 && strcmp(arguments[1], "--profile") == 0) {
        profile = read_profile(arguments[2]);
        next = 3;
    }
    const bool understood = roadpose_can_settings_default(settings, profile) &&
                            (next == count || (next + 1 == count && arguments[next][0] != '-'));
    return understood ? next : 0;
}

/* The exit status. */
static int listen_file(const char *path, listener_t *listener) {
    FILE *const file = (path != NULL) ? fopen(path, "r") : stdin;
    bool is_read = file != NULL && listen_to(file, listener);
    if (!is_read)
        fprintf(stderr, "roadpose-listen: %s: %s\n", path != NULL ? path : "standard input", strerror(errno));
    if (file != NULL && file != stdin)
        (void)fclose(file);
    if (is_read && (fflush(stdout) != 0 || ferror(stdout) != 0)) {
        (void)fputs("roadpose-listen: standard output cannot be written\n", stderr);
        return 1;
    }
    return is_read ? 0 : 3;
}

int main(int count, char *arguments[]) {
    roadpose_can_settings_t settings;
    listener_t listener = {.last_us = UINT64_MAX};
    if (count == 2 && strcmp(arguments[1], "--help") == 0)
        return (fputs(usage, stdout) < 0 || fflush(stdout) != 0) ? 1 : 0;
    const int next = read_arguments(count, arguments, &settings);
    if (next == 0) {
        (void)fputs(usage, stderr);
        return 2;
    }
    (void)roadpose_can_receive_init(&listener.receive, &settings);
    return listen_file((next < count) ? arguments[next] : NULL, &listener);
}
