/* Instead of socketcan.c where the system has no SocketCAN. */
#include "socketcan.h"

#include <string.h>

roadpose_socketcan_result_t roadpose_socketcan_open(roadpose_socketcan_t *can, const char *name) {
    (void)name;
    memset(can, 0, sizeof *can);
    can->socket = -1;
    return ROADPOSE_SOCKETCAN_NO_SUPPORT;
}

roadpose_can_send_t roadpose_socketcan_send(roadpose_socketcan_t *can, uint32_t id, const uint8_t data[8]) {
    (void)id;
    (void)data;
    can->counts.down++;
    return ROADPOSE_CAN_DOWN;
}

void roadpose_socketcan_recover(roadpose_socketcan_t *can, uint64_t now_us) {
    (void)can;
    (void)now_us;
}

void roadpose_socketcan_close(roadpose_socketcan_t *can) {
    (void)can;
}
