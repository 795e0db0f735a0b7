/* The log format of can-utils, written and read. */
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "can_output.h"
#include "roadpose/can.h"
#include "unity.h"

static const uint8_t data[8] = {0x11, 0x22, 0x33, 0x44, 0x55, 0x66, 0x77, 0x88};
static char path[64];

void setUp(void) {
    (void)snprintf(path, sizeof path, "candump-test-%ld.log", (long)getpid());
}

void tearDown(void) {
    (void)remove(path);
}

static void expect_file(const char *expected) {
    char text[1024] = "";
    FILE *file = fopen(path, "r");
    TEST_ASSERT_NOT_NULL(file);
    (void)fread(text, 1, sizeof text - 1, file);
    (void)fclose(file);
    TEST_ASSERT_EQUAL_STRING(expected, text);
}

static void lines_look_as_can_utils_writes_them(void) {
    roadpose_candump_t log;
    TEST_ASSERT_TRUE(roadpose_candump_open(&log, path, "vcan0"));
    roadpose_candump_write(&log, UINT64_C(1436509052249713), 0x123, data);
    expect_file("(1436509052.249713) vcan0 123#1122334455667788\n"); /* at once */
    roadpose_candump_write(&log, 42, ROADPOSE_CAN_EXTENDED | 0x1ABCDEFu, data);
    TEST_ASSERT_TRUE(roadpose_candump_close(&log));
    TEST_ASSERT_TRUE(roadpose_candump_close(&log));
    roadpose_candump_write(&log, 43, 0x123, data); /* closed: nothing happens */
    expect_file("(1436509052.249713) vcan0 123#1122334455667788\n"
                "(0000000000.000042) vcan0 01ABCDEF#1122334455667788\n");
}

static void lines_are_read(void) {
    roadpose_candump_frame_t frame;
    TEST_ASSERT_TRUE(roadpose_candump_parse("(1436509052.249713) vcan0 123#1122334455667788\n", &frame));
    TEST_ASSERT_TRUE(frame.time_us == UINT64_C(1436509052249713));
    TEST_ASSERT_EQUAL_HEX32(0x123, frame.id);
    TEST_ASSERT_EQUAL_UINT8(8, frame.length);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(data, frame.data, 8);
    TEST_ASSERT_TRUE(roadpose_candump_parse("(0.000001) can0 01abcdef#aBcD T", &frame));
    TEST_ASSERT_EQUAL_HEX32(ROADPOSE_CAN_EXTENDED | 0x1ABCDEFu, frame.id);
    TEST_ASSERT_EQUAL_UINT8(2, frame.length);
    TEST_ASSERT_EQUAL_HEX8(0xAB, frame.data[0]);
    TEST_ASSERT_TRUE(roadpose_candump_parse("(0.000001) can0 7FF#", &frame));
    TEST_ASSERT_EQUAL_UINT8(0, frame.length);
}

static void other_lines_are_refused(void) {
    const char *const lines[] = {"",
                                 "\n",
                                 "garbage",
                                 "(1.000000) can0",
                                 "(1.000000) can0 ",
                                 "(1.000000) can0 123",
                                 "(1.000000) can0 123#1",
                                 "(1.000000) can0 123#112233445566778899",
                                 "(1.000000) can0 123#11xx",
                                 "(1.000000) can0 123##1112233",  /* CAN FD */
                                 "(1.000000) can0 123#R",         /* remote */
                                 "(1.000000) can0 800#11",        /* no 11 bits */
                                 "(1.000000) can0 20000040#0000", /* an error frame */
                                 "1.000000 can0 123#11",
                                 "(1.000000) a-name-that-is-far-too-long-for-any-interface 123#11"};
    roadpose_candump_frame_t frame;
    for (unsigned i = 0; i < sizeof lines / sizeof lines[0]; i++)
        TEST_ASSERT_FALSE_MESSAGE(roadpose_candump_parse(lines[i], &frame), lines[i]);
}

static void a_log_that_cannot_be_made_is_told(void) {
    roadpose_candump_t log;
    TEST_ASSERT_FALSE(roadpose_candump_open(&log, "no-such-folder/file.log", "vcan0"));
}

static void a_full_disk_is_told(void) {
    roadpose_candump_t log;
    if (!roadpose_candump_open(&log, "/dev/full", "vcan0"))
        TEST_IGNORE_MESSAGE("no /dev/full here");
    roadpose_candump_write(&log, 1, 0x123, data);
    TEST_ASSERT_FALSE(roadpose_candump_close(&log));
}

static void an_output_without_a_bus_logs_every_frame(void) {
    static roadpose_can_context_t output;
    roadpose_can_transmit_t transmit;
    roadpose_candump_frame_t frame;
    char line[128];
    roadpose_can_output_init(&output);
    TEST_ASSERT_TRUE(roadpose_can_output_add_log(&output, path, "a-name-longer-than-15"));
    const roadpose_can_port_t port = roadpose_can_output_port(&output);
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_DONE, roadpose_can_transmit_init(&transmit, NULL, &port));
    for (unsigned cycle = 0; cycle < 5; cycle++) {
        output.now_us = cycle * 100000u;
        TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_DONE, roadpose_can_transmit_cycle(&transmit, output.now_us));
    }
    TEST_ASSERT_TRUE(roadpose_can_output_close(&output));
    FILE *file = fopen(path, "r");
    TEST_ASSERT_NOT_NULL(file);
    for (unsigned i = 0; i < 15; i++) {
        TEST_ASSERT_NOT_NULL(fgets(line, sizeof line, file));
        TEST_ASSERT_TRUE(roadpose_candump_parse(line, &frame));
        TEST_ASSERT_EQUAL_HEX32(0x3D0 + i % 3, frame.id);
        TEST_ASSERT_TRUE(frame.time_us == i / 3 * UINT64_C(100000));
    }
    TEST_ASSERT_NULL(fgets(line, sizeof line, file));
    (void)fclose(file);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(lines_look_as_can_utils_writes_them);
    RUN_TEST(lines_are_read);
    RUN_TEST(other_lines_are_refused);
    RUN_TEST(a_log_that_cannot_be_made_is_told);
    RUN_TEST(a_full_disk_is_told);
    RUN_TEST(an_output_without_a_bus_logs_every_frame);
    return UNITY_END();
}
