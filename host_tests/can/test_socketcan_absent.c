/* The SocketCAN port of a system that has none: it says so, and answers like a bus that is down. */
#include "socketcan.h"
#include "unity.h"

void setUp(void) {
}

void tearDown(void) {
}

static void it_is_told_and_counted(void) {
    const uint8_t data[8] = {0};
    roadpose_socketcan_t can;
    TEST_ASSERT_EQUAL_INT(ROADPOSE_SOCKETCAN_NO_SUPPORT, roadpose_socketcan_open(&can, "can0"));
    roadpose_socketcan_recover(&can, 0);
    for (uint32_t i = 1; i < 4; i++) {
        TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_DOWN, roadpose_socketcan_send(&can, 0x3D0, data));
        TEST_ASSERT_EQUAL_UINT32(i, can.counts.down);
    }
    roadpose_socketcan_close(&can);
    TEST_ASSERT_EQUAL_STRING("this system has no CAN sockets", roadpose_socketcan_words(ROADPOSE_SOCKETCAN_NO_SUPPORT));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(it_is_told_and_counted);
    return UNITY_END();
}
