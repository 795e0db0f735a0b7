#include "socketcan.h"

const char *roadpose_socketcan_words(roadpose_socketcan_result_t result) {
    const char *words = "unknown";
    switch (result) {
    case ROADPOSE_SOCKETCAN_OPEN:
        words = "open";
        break;
    case ROADPOSE_SOCKETCAN_NO_SUPPORT:
        words = "this system has no CAN sockets";
        break;
    case ROADPOSE_SOCKETCAN_NO_INTERFACE:
        words = "no interface of this name";
        break;
    case ROADPOSE_SOCKETCAN_BAD_NAME:
        words = "not a name for an interface";
        break;
    case ROADPOSE_SOCKETCAN_REFUSED:
        words = "refused by the system";
        break;
    default:
        break;
    }
    return words;
}
