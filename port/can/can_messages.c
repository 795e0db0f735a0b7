/* The three messages: which signal lies where. docs/can.md and roadpose.dbc are checked against this by a host test. */
#include "roadpose/can.h"

#include <stddef.h>

#include "can_signals.h"

#define ANGLE_5_MILLIDEG_Q46 INT64_C(806366410203) /* 2^46 / 87.26646... */
#define ANGLE_5_MILLIDEG_Q32 INT64_C(374806602903)
#define ANGLE_20_MILLIDEG_Q46 INT64_C(201591602551) /* 2^46 / 349.06585... */
#define ANGLE_20_MILLIDEG_Q32 INT64_C(1499226411614)

static const roadpose_can_angle_t pitch = {{24, 14, 16382}, 8192, ANGLE_5_MILLIDEG_Q46, ANGLE_5_MILLIDEG_Q32};
static const roadpose_can_angle_t roll = {{38, 14, 16382}, 8192, ANGLE_5_MILLIDEG_Q46, ANGLE_5_MILLIDEG_Q32};
static const roadpose_can_linear_t height = {{52, 12, 4094}, 200000, 1250};

static const roadpose_can_angle_t yaw = {{24, 12, 4094}, 2048, ANGLE_20_MILLIDEG_Q46, ANGLE_20_MILLIDEG_Q32};
static const roadpose_can_linear_t support = {{36, 7, 100}, 0, 10};
static const roadpose_can_linear_t residual = {{43, 7, 126}, 0, 25};
static const roadpose_can_linear_t range_near = {{50, 6, 62}, 0, 500};
static const roadpose_can_linear_t range_far = {{56, 8, 254}, 0, 1000};

static const roadpose_can_place_t pose_status = {24, 4, 14};
static const roadpose_can_place_t yaw_status = {28, 4, 14};
static const roadpose_can_place_t frame_count = {32, 8, 254};
static const roadpose_can_place_t refused_count = {40, 8, 254};
static const roadpose_can_place_t overwritten_count = {48, 8, 254};
static const roadpose_can_place_t dropped_count = {56, 8, 254};

static uint64_t angle_bits(const roadpose_can_angle_t *signal, unsigned valid, int32_t urad) {
    return roadpose_can_place(&signal->place, roadpose_can_angle_code(signal, valid != 0u, urad));
}

static uint64_t linear_bits(const roadpose_can_linear_t *signal, unsigned valid, int64_t value) {
    return roadpose_can_place(&signal->place, roadpose_can_linear_code(signal, valid != 0u, value));
}

static uint64_t count_bits(const roadpose_can_place_t *place, unsigned valid, uint32_t count) {
    return roadpose_can_place(place, roadpose_can_count_code(place, valid != 0u, count));
}

static uint64_t state_bits(const roadpose_can_place_t *place, uint8_t state) {
    return roadpose_can_place(place, (state > place->last) ? roadpose_can_invalid(place) : state);
}

void roadpose_can_pack_pose(const roadpose_can_pose_t *message, uint8_t data[8]) {
    uint64_t signals = UINT64_MAX;
    if (message != NULL) {
        signals = angle_bits(&pitch, message->valid & ROADPOSE_CAN_PITCH, message->pitch_urad);
        signals |= angle_bits(&roll, message->valid & ROADPOSE_CAN_ROLL, message->roll_urad);
        signals |= linear_bits(&height, message->valid & ROADPOSE_CAN_HEIGHT, message->height_um);
    }
    roadpose_can_write(signals, data);
}

void roadpose_can_pack_quality(const roadpose_can_quality_t *message, uint8_t data[8]) {
    uint64_t signals = UINT64_MAX;
    if (message != NULL) {
        signals = angle_bits(&yaw, message->valid & ROADPOSE_CAN_YAW, message->yaw_urad);
        signals |= linear_bits(&support, message->valid & ROADPOSE_CAN_SUPPORT, message->support_permille);
        signals |= linear_bits(&residual, message->valid & ROADPOSE_CAN_RESIDUAL, message->residual_millipx);
        signals |= linear_bits(&range_near, message->valid & ROADPOSE_CAN_RANGE_NEAR, message->range_near_mm);
        signals |= linear_bits(&range_far, message->valid & ROADPOSE_CAN_RANGE_FAR, message->range_far_mm);
    }
    roadpose_can_write(signals, data);
}

void roadpose_can_pack_status(const roadpose_can_status_t *message, uint8_t data[8]) {
    uint64_t signals = UINT64_MAX;
    if (message != NULL) {
        unsigned valid = message->valid;
        signals = state_bits(&pose_status, message->pose_status);
        signals |= state_bits(&yaw_status, message->yaw_status);
        signals |= count_bits(&frame_count, valid & ROADPOSE_CAN_FRAME_COUNT, message->frame_count);
        signals |= count_bits(&refused_count, valid & ROADPOSE_CAN_REFUSED_COUNT, message->refused_count);
        signals |= count_bits(&overwritten_count, valid & ROADPOSE_CAN_OVERWRITTEN_COUNT, message->overwritten_count);
        signals |= count_bits(&dropped_count, valid & ROADPOSE_CAN_DROPPED_COUNT, message->dropped_count);
    }
    roadpose_can_write(signals, data);
}

static uint8_t take_angle(const roadpose_can_angle_t *signal, const uint8_t data[8], int32_t *urad, unsigned bit) {
    return (uint8_t)(roadpose_can_angle_value(signal, roadpose_can_take(&signal->place, data), urad) ? bit : 0u);
}

static uint8_t take_linear(const roadpose_can_linear_t *signal, const uint8_t data[8], int32_t *value, unsigned bit) {
    return (uint8_t)(roadpose_can_linear_value(signal, roadpose_can_take(&signal->place, data), value) ? bit : 0u);
}

static uint8_t take_count(const roadpose_can_place_t *place, const uint8_t data[8], uint32_t *count, unsigned bit) {
    return (uint8_t)(roadpose_can_count_value(place, roadpose_can_take(place, data), count) ? bit : 0u);
}

void roadpose_can_unpack_pose(const uint8_t data[8], roadpose_can_pose_t *message) {
    message->valid = (uint8_t)(take_angle(&pitch, data, &message->pitch_urad, ROADPOSE_CAN_PITCH) |
                               take_angle(&roll, data, &message->roll_urad, ROADPOSE_CAN_ROLL) |
                               take_linear(&height, data, &message->height_um, ROADPOSE_CAN_HEIGHT));
}

/* No value of these signals is negative, and none is above 254 000: the conversions keep them. */
void roadpose_can_unpack_quality(const uint8_t data[8], roadpose_can_quality_t *message) {
    int32_t value[4];
    message->valid = (uint8_t)(take_angle(&yaw, data, &message->yaw_urad, ROADPOSE_CAN_YAW) |
                               take_linear(&support, data, &value[0], ROADPOSE_CAN_SUPPORT) |
                               take_linear(&residual, data, &value[1], ROADPOSE_CAN_RESIDUAL) |
                               take_linear(&range_near, data, &value[2], ROADPOSE_CAN_RANGE_NEAR) |
                               take_linear(&range_far, data, &value[3], ROADPOSE_CAN_RANGE_FAR));
    message->support_permille = (uint16_t)value[0];
    message->residual_millipx = (uint16_t)value[1];
    message->range_near_mm = (uint32_t)value[2];
    message->range_far_mm = (uint32_t)value[3];
}

void roadpose_can_unpack_status(const uint8_t data[8], roadpose_can_status_t *message) {
    message->pose_status = (uint8_t)roadpose_can_take(&pose_status, data);
    message->yaw_status = (uint8_t)roadpose_can_take(&yaw_status, data);
    message->valid =
        (uint8_t)(take_count(&frame_count, data, &message->frame_count, ROADPOSE_CAN_FRAME_COUNT) |
                  take_count(&refused_count, data, &message->refused_count, ROADPOSE_CAN_REFUSED_COUNT) |
                  take_count(&overwritten_count, data, &message->overwritten_count, ROADPOSE_CAN_OVERWRITTEN_COUNT) |
                  take_count(&dropped_count, data, &message->dropped_count, ROADPOSE_CAN_DROPPED_COUNT));
}
