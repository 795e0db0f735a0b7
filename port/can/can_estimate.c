/* From the core's result to what goes on the bus. */
#include "roadpose/can.h"

#include <stddef.h>

static const roadpose_can_estimate_t nothing_known = {.pose_status = ROADPOSE_CAN_STATUS_BAD_FRAME,
                                                      .yaw_status = ROADPOSE_CAN_STATUS_INVALID};

static unsigned valid_bit(bool valid, unsigned bit) {
    return valid ? bit : 0u;
}

static void fill_pose(roadpose_can_pose_t *message, const roadpose_pose_t *pose) {
    message->valid = (uint8_t)(valid_bit((pose->observed & ROADPOSE_OBSERVED_PITCH) != 0u, ROADPOSE_CAN_PITCH) |
                               valid_bit((pose->observed & ROADPOSE_OBSERVED_ROLL) != 0u, ROADPOSE_CAN_ROLL) |
                               valid_bit((pose->observed & ROADPOSE_OBSERVED_HEIGHT) != 0u, ROADPOSE_CAN_HEIGHT));
    message->pitch_urad = pose->pitch_urad;
    message->roll_urad = pose->roll_urad;
    message->height_um = pose->height_um;
}

/* A refused frame has the figures that the work came to before it stopped. 0 there means "did not come so far". */
static void fill_quality(roadpose_can_quality_t *message, const roadpose_pose_t *pose) {
    bool ok = pose->status == (uint8_t)ROADPOSE_STATUS_OK;
    message->valid = (uint8_t)(valid_bit(ok || (pose->support_permille != 0u), ROADPOSE_CAN_SUPPORT) |
                               valid_bit(ok || (pose->residual_millipx != 0u), ROADPOSE_CAN_RESIDUAL) |
                               valid_bit(ok || (pose->range_near_mm != 0u), ROADPOSE_CAN_RANGE_NEAR) |
                               valid_bit(ok || (pose->range_far_mm != 0u), ROADPOSE_CAN_RANGE_FAR));
    message->support_permille = pose->support_permille;
    message->residual_millipx = pose->residual_millipx;
    message->range_near_mm = pose->range_near_mm;
    message->range_far_mm = pose->range_far_mm;
}

void roadpose_can_estimate(roadpose_can_estimate_t *estimate, const roadpose_pose_t *pose) {
    if (estimate == NULL) {
        return;
    }
    *estimate = nothing_known;
    if (pose != NULL) {
        estimate->pose_status = pose->status;
        fill_pose(&estimate->pose, pose);
        fill_quality(&estimate->quality, pose);
    }
}

void roadpose_can_estimate_yaw(roadpose_can_estimate_t *estimate, int32_t yaw_urad, uint8_t yaw_status) {
    if (estimate == NULL) {
        return;
    }
    unsigned others = estimate->quality.valid & ~ROADPOSE_CAN_YAW;
    estimate->quality.valid = (uint8_t)(others | valid_bit(yaw_status == 0u, ROADPOSE_CAN_YAW));
    estimate->quality.yaw_urad = yaw_urad;
    estimate->yaw_status = yaw_status;
}

const char *roadpose_can_status_word(uint8_t pose_status) {
    /* Characters, not pointers: a table of pointers would be relocated, so writable, in position-independent code. */
    static const char core[ROADPOSE_STATUS_COUNT][16] = {
        "ok", "no_disparity", "no_road", "little_support", "short_range", "poor_fit", "outside_limits"};
    const char *word = "reserved";
    if (pose_status < ROADPOSE_STATUS_COUNT) {
        word = core[pose_status];
    } else if (pose_status == ROADPOSE_CAN_STATUS_BAD_FRAME) {
        word = "bad_frame";
    } else if (pose_status == ROADPOSE_CAN_STATUS_NO_FRAME) {
        word = "no_frame";
    } else if (pose_status >= ROADPOSE_CAN_STATUS_INVALID) {
        word = "invalid";
    } else {
        /* codes of statuses to come */
    }
    return word;
}
