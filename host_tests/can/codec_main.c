/* roadpose-can-codec: the C code of port/can, line by line, for the tests that compare it with cantools and
 * autosar-e2e. One command a line on standard input, one answer a line on standard output: pose VALID PITCH_URAD
 * ROLL_URAD HEIGHT_UM                                    -> 16 hexadecimal digits quality VALID YAW_URAD
 * SUPPORT_PERMILLE RESIDUAL_MILLIPX NEAR_MM FAR_MM      -> 16 hexadecimal digits status VALID POSE_STATUS YAW_STATUS
 * FRAMES REFUSED OVERWRITTEN DROPPED       -> 16 hexadecimal digits again MESSAGE HEX -> unpacked and packed again
 *   protect PROFILE MESSAGE COUNTER HEX                                          -> the protected frame
 *   check PROFILE MESSAGE HEX                                                    -> word of the E2E status, a receiver
 *                                                                                   each for profile and message
 *   list MESSAGE                                                                 -> 16 data identifiers of profile 2
 * Exit status 2 on anything else. */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "roadpose/can.h"

static void print_frame(const uint8_t data[8]) {
    for (unsigned i = 0; i < 8; i++)
        printf("%02X", data[i]);
    printf("\n");
}

static bool read_frame(const char *hex, uint8_t data[8]) {
    unsigned byte;
    if (strlen(hex) != 16)
        return false;
    for (unsigned i = 0; i < 8; i++) {
        if (sscanf(hex + 2 * i, "%2x", &byte) != 1)
            return false;
        data[i] = (uint8_t)byte;
    }
    return true;
}

static bool pack_pose(const char *line) {
    roadpose_can_pose_t message;
    uint8_t data[8];
    if (sscanf(line, "pose %" SCNu8 " %" SCNd32 " %" SCNd32 " %" SCNd32, &message.valid, &message.pitch_urad,
               &message.roll_urad, &message.height_um) != 4)
        return false;
    roadpose_can_pack_pose(&message, data);
    print_frame(data);
    return true;
}

static bool pack_quality(const char *line) {
    roadpose_can_quality_t message;
    uint8_t data[8];
    if (sscanf(line, "quality %" SCNu8 " %" SCNd32 " %" SCNu16 " %" SCNu16 " %" SCNu32 " %" SCNu32, &message.valid,
               &message.yaw_urad, &message.support_permille, &message.residual_millipx, &message.range_near_mm,
               &message.range_far_mm) != 6)
        return false;
    roadpose_can_pack_quality(&message, data);
    print_frame(data);
    return true;
}

static bool pack_status(const char *line) {
    roadpose_can_status_t message;
    uint8_t data[8];
    if (sscanf(line, "status %" SCNu8 " %" SCNu8 " %" SCNu8 " %" SCNu32 " %" SCNu32 " %" SCNu32 " %" SCNu32,
               &message.valid, &message.pose_status, &message.yaw_status, &message.frame_count, &message.refused_count,
               &message.overwritten_count, &message.dropped_count) != 7)
        return false;
    roadpose_can_pack_status(&message, data);
    print_frame(data);
    return true;
}

static void pack_again(unsigned message, const uint8_t in[8], uint8_t out[8]) {
    roadpose_can_pose_t pose;
    roadpose_can_quality_t quality;
    roadpose_can_status_t status;
    if (message == ROADPOSE_CAN_MESSAGE_POSE) {
        roadpose_can_unpack_pose(in, &pose);
        roadpose_can_pack_pose(&pose, out);
    } else if (message == ROADPOSE_CAN_MESSAGE_QUALITY) {
        roadpose_can_unpack_quality(in, &quality);
        roadpose_can_pack_quality(&quality, out);
    } else {
        roadpose_can_unpack_status(in, &status);
        roadpose_can_pack_status(&status, out);
    }
}

static bool again(const char *line) {
    unsigned message;
    char hex[32];
    uint8_t in[8], out[8];
    if (sscanf(line, "again %u %31s", &message, hex) != 2 || !read_frame(hex, in))
        return false;
    pack_again(message, in, out);
    print_frame(out);
    return true;
}

static bool settings_of(unsigned profile, unsigned message, roadpose_can_settings_t *settings) {
    return message < ROADPOSE_CAN_MESSAGES && roadpose_can_settings_default(settings, (roadpose_e2e_profile_t)profile);
}

static bool protect(const char *line) {
    unsigned profile, message;
    uint8_t counter, data[8];
    char hex[32];
    roadpose_can_settings_t settings;
    if (sscanf(line, "protect %u %u %" SCNu8 " %31s", &profile, &message, &counter, hex) != 4 ||
        !read_frame(hex, data) || !settings_of(profile, message, &settings) ||
        !roadpose_e2e_protect(&settings.e2e[message], counter, data))
        return false;
    print_frame(data);
    return true;
}

static bool check(const char *line) {
    static roadpose_e2e_receiver_t receiver[6][ROADPOSE_CAN_MESSAGES];
    unsigned profile, message;
    uint8_t data[8];
    char hex[32];
    roadpose_can_settings_t settings;
    if (sscanf(line, "check %u %u %31s", &profile, &message, hex) != 3 || !read_frame(hex, data) ||
        !settings_of(profile, message, &settings))
        return false;
    puts(roadpose_e2e_status_word(roadpose_e2e_check(&settings.e2e[message], &receiver[profile][message], data)));
    return true;
}

static bool list(const char *line) {
    unsigned message;
    roadpose_can_settings_t settings;
    if (sscanf(line, "list %u", &message) != 1 || !settings_of(ROADPOSE_E2E_PROFILE_2, message, &settings))
        return false;
    for (unsigned i = 0; i < ROADPOSE_E2E_LIST_ENTRIES; i++)
        printf("%u%s", settings.e2e[message].data_id_list[i], (i + 1 < ROADPOSE_E2E_LIST_ENTRIES) ? " " : "\n");
    return true;
}

int main(void) {
    char line[256];
    while (fgets(line, sizeof line, stdin) != NULL) {
        if (!pack_pose(line) && !pack_quality(line) && !pack_status(line) && !again(line) && !protect(line) &&
            !check(line) && !list(line)) {
            fprintf(stderr, "not understood: %s", line);
            return 2;
        }
    }
    return 0;
}
