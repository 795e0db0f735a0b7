/* The listener's side, for any ECU that wants the pose. */
#include "roadpose/can.h"

#include <stddef.h>
#include <string.h>

static void forget(roadpose_can_receive_t *receive, unsigned message) {
    static const uint8_t invalid[ROADPOSE_CAN_BYTES] = {0, 0, 0, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF};
    if (message == (unsigned)ROADPOSE_CAN_MESSAGE_POSE) {
        roadpose_can_unpack_pose(invalid, &receive->view.pose);
    } else if (message == (unsigned)ROADPOSE_CAN_MESSAGE_QUALITY) {
        roadpose_can_unpack_quality(invalid, &receive->view.quality);
    } else {
        roadpose_can_unpack_status(invalid, &receive->view.status);
    }
}

static void take_over(roadpose_can_receive_t *receive, unsigned message, const uint8_t data[8]) {
    receive->missed[message] = 0;
    if (message == (unsigned)ROADPOSE_CAN_MESSAGE_POSE) {
        roadpose_can_unpack_pose(data, &receive->view.pose);
    } else if (message == (unsigned)ROADPOSE_CAN_MESSAGE_QUALITY) {
        roadpose_can_unpack_quality(data, &receive->view.quality);
    } else {
        roadpose_can_unpack_status(data, &receive->view.status);
    }
}

roadpose_can_result_t roadpose_can_receive_init(roadpose_can_receive_t *receive,
                                                const roadpose_can_settings_t *settings) {
    roadpose_can_settings_t defaults;
    if (receive == NULL) {
        return ROADPOSE_CAN_ERROR_NULL;
    }
    (void)roadpose_can_settings_default(&defaults, ROADPOSE_E2E_PROFILE_1);
    const roadpose_can_settings_t *chosen = (settings != NULL) ? settings : &defaults;
    if (!roadpose_can_settings_valid(chosen)) {
        return ROADPOSE_CAN_ERROR_SETTINGS;
    }
    (void)memset(receive, 0, sizeof *receive);
    receive->settings = *chosen;
    for (unsigned message = 0; message < ROADPOSE_CAN_MESSAGES; message++) {
        receive->view.e2e[message] = (uint8_t)ROADPOSE_E2E_NO_NEW_DATA;
        forget(receive, message);
    }
    return ROADPOSE_CAN_DONE;
}

static unsigned find_message(const roadpose_can_receive_t *receive, uint32_t id) {
    unsigned message = 0;
    while ((message < ROADPOSE_CAN_MESSAGES) && (receive->settings.id[message] != id)) {
        message++;
    }
    return message;
}

/* For the counter, a frame of the wrong length is as good as none. */
static roadpose_e2e_status_t check(roadpose_can_receive_t *receive, unsigned message, const uint8_t *data,
                                   uint8_t length) {
    bool whole = length == ROADPOSE_CAN_BYTES;
    roadpose_e2e_status_t status =
        roadpose_e2e_check(&receive->settings.e2e[message], &receive->receiver[message], whole ? data : NULL);
    return whole ? status : ROADPOSE_E2E_CRC_ERROR;
}

roadpose_can_message_t roadpose_can_receive_frame(roadpose_can_receive_t *receive, uint32_t id, const uint8_t *data,
                                                  uint8_t length) {
    if ((receive == NULL) || (data == NULL)) {
        return ROADPOSE_CAN_MESSAGE_NONE;
    }
    unsigned message = find_message(receive, id);
    if (message < ROADPOSE_CAN_MESSAGES) {
        roadpose_e2e_status_t status = check(receive, message, data, length);
        receive->view.e2e[message] = (uint8_t)status;
        receive->arrived[message] = true;
        if (roadpose_e2e_usable(status)) {
            take_over(receive, message, data);
        } else {
            receive->view.not_usable[message]++;
        }
    }
    return (roadpose_can_message_t)message;
}

static void end_cycle(roadpose_can_receive_t *receive, unsigned message) {
    if (!receive->arrived[message]) {
        receive->view.e2e[message] =
            (uint8_t)roadpose_e2e_check(&receive->settings.e2e[message], &receive->receiver[message], NULL);
    }
    receive->arrived[message] = false;
    if (receive->missed[message] < UINT16_MAX) {
        receive->missed[message]++;
    }
    if (receive->missed[message] > receive->settings.timeout_cycles) {
        forget(receive, message);
    }
}

void roadpose_can_receive_cycle(roadpose_can_receive_t *receive) {
    if (receive == NULL) {
        return;
    }
    for (unsigned message = 0; message < ROADPOSE_CAN_MESSAGES; message++) {
        end_cycle(receive, message);
    }
}
