/* The SocketCAN port against a kernel that fails in every way. */
#include <errno.h>
#include <string.h>

#include <linux/can.h>
#include <linux/can/error.h>

#include "can_output.h"
#include "fake_kernel.h"
#include "roadpose/can.h"
#include "unity.h"

#define CYCLES 12u

static roadpose_socketcan_t can;
static const uint8_t data[8] = {1, 2, 3, 4, 5, 6, 7, 8};

void setUp(void) {
    fake_kernel_init();
}

void tearDown(void) {
    roadpose_socketcan_close(&can);
    TEST_ASSERT_EQUAL_INT(0, kernel.opened);
    TEST_ASSERT_FALSE_MESSAGE(kernel.may_block, "a call may have waited");
}

static void expect_send(roadpose_can_send_t answer) {
    TEST_ASSERT_EQUAL_INT(answer, roadpose_socketcan_send(&can, 0x3D0, data));
}

static void open_vcan(void) {
    TEST_ASSERT_EQUAL_INT(ROADPOSE_SOCKETCAN_OPEN, roadpose_socketcan_open(&can, "vcan0"));
}

static void frames_reach_the_interface(void) {
    open_vcan();
    expect_send(ROADPOSE_CAN_SENT);
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_SENT, roadpose_socketcan_send(&can, ROADPOSE_CAN_EXTENDED | 0x12345u, data));
    TEST_ASSERT_EQUAL_INT(2, kernel.frames);
    TEST_ASSERT_EQUAL_HEX32(0x3D0, kernel.frame[0].id);
    TEST_ASSERT_EQUAL_HEX32(CAN_EFF_FLAG | 0x12345u, kernel.frame[1].id);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(data, kernel.frame[0].data, 8);
    TEST_ASSERT_EQUAL_UINT32(2, can.counts.sent);
}

static void the_socket_is_asked_for_what_it_needs(void) {
    open_vcan();
    TEST_ASSERT_TRUE(kernel.is_nonblocking);
    TEST_ASSERT_FALSE_MESSAGE(kernel.hears_data, "every frame on the bus wakes us and fills the queue");
    TEST_ASSERT_EQUAL_HEX32(CAN_ERR_BUSOFF | CAN_ERR_RESTARTED, kernel.error_mask);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, kernel.send_buffer, "a long queue sends old poses");
}

static void a_missing_interface_is_told_and_waited_for(void) {
    kernel.has_vcan = false;
    TEST_ASSERT_EQUAL_INT(ROADPOSE_SOCKETCAN_NO_INTERFACE, roadpose_socketcan_open(&can, "vcan0"));
    TEST_ASSERT_EQUAL_INT(ENODEV, can.last_errno);
    expect_send(ROADPOSE_CAN_DOWN);
    roadpose_socketcan_recover(&can, 0);
    expect_send(ROADPOSE_CAN_DOWN);
    kernel.has_vcan = true;
    roadpose_socketcan_recover(&can, 0);
    expect_send(ROADPOSE_CAN_SENT);
}

static void a_kernel_without_can_is_told(void) {
    const int calls = 1;
    kernel.has_can = false;
    TEST_ASSERT_EQUAL_INT(ROADPOSE_SOCKETCAN_NO_SUPPORT, roadpose_socketcan_open(&can, "vcan0"));
    expect_send(ROADPOSE_CAN_DOWN);
    roadpose_socketcan_recover(&can, 0);
    TEST_ASSERT_EQUAL_INT(calls, kernel.calls); /* it will not come: nobody asks again */
}

static void names_that_no_interface_can_have_are_refused(void) {
    TEST_ASSERT_EQUAL_INT(ROADPOSE_SOCKETCAN_BAD_NAME, roadpose_socketcan_open(&can, ""));
    TEST_ASSERT_EQUAL_INT(ROADPOSE_SOCKETCAN_BAD_NAME, roadpose_socketcan_open(&can, "a234567890123456"));
    expect_send(ROADPOSE_CAN_DOWN);
    roadpose_socketcan_recover(&can, 0);
    TEST_ASSERT_EQUAL_INT(0, kernel.calls);
    TEST_ASSERT_EQUAL_INT(ROADPOSE_SOCKETCAN_NO_INTERFACE, roadpose_socketcan_open(&can, "a23456789012345"));
}

static void a_full_queue_is_ordinary(void) {
    const int reasons[] = {ENOBUFS, EAGAIN, EINTR};
    open_vcan();
    for (unsigned i = 0; i < 3; i++) {
        kernel.fail_at = kernel.calls + 2; /* recv, then send */
        kernel.fail_errno = reasons[i];
        expect_send(ROADPOSE_CAN_FULL);
        expect_send(ROADPOSE_CAN_SENT);
    }
    TEST_ASSERT_EQUAL_UINT32(3, can.counts.full);
    TEST_ASSERT_EQUAL_UINT32(1, can.counts.opened);
}

static void an_interface_that_goes_down_and_up_is_used_again_at_once(void) {
    open_vcan();
    fake_kernel_set_up(false);
    expect_send(ROADPOSE_CAN_DOWN);
    expect_send(ROADPOSE_CAN_DOWN);
    fake_kernel_set_up(true);
    expect_send(ROADPOSE_CAN_SENT);
    fake_kernel_set_up(false);
    fake_kernel_set_up(true); /* nobody sent meanwhile: the error is still kept for us */
    expect_send(ROADPOSE_CAN_SENT);
    TEST_ASSERT_EQUAL_UINT32(1, can.counts.opened);
    TEST_ASSERT_EQUAL_UINT32(2, can.counts.down);
}

static void an_error_kept_between_reading_and_writing_costs_no_frame(void) {
    open_vcan();
    kernel.fail_at = kernel.calls + 2;
    kernel.fail_errno = ENETDOWN;
    expect_send(ROADPOSE_CAN_SENT);
}

static void an_interface_that_vanishes_is_opened_again_when_it_comes_back(void) {
    open_vcan();
    fake_kernel_remove();
    expect_send(ROADPOSE_CAN_DOWN);
    roadpose_socketcan_recover(&can, 0);
    expect_send(ROADPOSE_CAN_DOWN);
    kernel.has_vcan = true;
    roadpose_socketcan_recover(&can, 0); /* there, but down */
    expect_send(ROADPOSE_CAN_DOWN);
    fake_kernel_set_up(true);
    expect_send(ROADPOSE_CAN_SENT);
    TEST_ASSERT_EQUAL_UINT32(2, can.counts.opened);
}

static void bus_off_lasts_until_the_restart(void) {
    open_vcan();
    fake_kernel_report(CAN_ERR_BUSOFF);
    expect_send(ROADPOSE_CAN_BUS_OFF);
    roadpose_socketcan_recover(&can, 0);
    expect_send(ROADPOSE_CAN_BUS_OFF);
    fake_kernel_report(CAN_ERR_RESTARTED);
    expect_send(ROADPOSE_CAN_SENT);
    TEST_ASSERT_EQUAL_UINT32(1, can.counts.bus_off);
}

static void bus_off_ends_when_the_interface_is_taken_down(void) {
    open_vcan();
    fake_kernel_report(CAN_ERR_BUSOFF);
    expect_send(ROADPOSE_CAN_BUS_OFF);
    fake_kernel_set_up(false);
    fake_kernel_set_up(true);
    expect_send(ROADPOSE_CAN_SENT);
}

/* A script that restarts the interface on bus-off is quicker than our next frame: we hear of the end first. */
static void bus_off_that_is_heard_of_too_late_does_not_last_for_ever(void) {
    open_vcan();
    fake_kernel_report(CAN_ERR_BUSOFF);
    fake_kernel_set_up(false);
    fake_kernel_set_up(true);
    expect_send(ROADPOSE_CAN_SENT);
    expect_send(ROADPOSE_CAN_BUS_OFF);
    roadpose_socketcan_recover(&can, 100000);
    roadpose_socketcan_recover(&can, 2099999);
    expect_send(ROADPOSE_CAN_BUS_OFF); /* Linux may not know yet that the carrier is gone */
    roadpose_socketcan_recover(&can, 2100000);
    expect_send(ROADPOSE_CAN_SENT);
}

static void bus_off_lasts_as_long_as_there_is_no_carrier(void) {
    open_vcan();
    kernel.has_no_carrier = true;
    fake_kernel_report(CAN_ERR_BUSOFF);
    for (uint64_t now_us = 0; now_us < 5000000; now_us += 100000) {
        expect_send(ROADPOSE_CAN_BUS_OFF);
        roadpose_socketcan_recover(&can, now_us);
    }
    TEST_ASSERT_EQUAL_INT(0, kernel.frames);
    kernel.has_no_carrier = false;
    roadpose_socketcan_recover(&can, 5000000);
    expect_send(ROADPOSE_CAN_SENT);
    fake_kernel_report(CAN_ERR_BUSOFF); /* again: the two seconds begin again */
    expect_send(ROADPOSE_CAN_BUS_OFF);
    roadpose_socketcan_recover(&can, 5100000);
    expect_send(ROADPOSE_CAN_BUS_OFF);
}

static void an_interface_that_is_bus_off_from_the_start_is_told(void) {
    kernel.has_no_carrier = true;
    open_vcan();
    expect_send(ROADPOSE_CAN_BUS_OFF);
    TEST_ASSERT_EQUAL_INT(0, kernel.frames); /* they would have been lost without a word */
    fake_kernel_report(CAN_ERR_RESTARTED);
    expect_send(ROADPOSE_CAN_SENT);
    roadpose_socketcan_close(&can);
    kernel.is_up = false;
    open_vcan();
    expect_send(ROADPOSE_CAN_DOWN); /* not bus-off: down */
    fake_kernel_set_up(true);
    expect_send(ROADPOSE_CAN_SENT);
}

/* An adapter is unplugged and plugged in again; the new one has its own two seconds. */
static void bus_off_ends_when_the_interface_vanishes(void) {
    open_vcan();
    fake_kernel_report(CAN_ERR_BUSOFF);
    expect_send(ROADPOSE_CAN_BUS_OFF);
    roadpose_socketcan_recover(&can, 0);
    fake_kernel_remove();
    expect_send(ROADPOSE_CAN_DOWN);
    kernel.has_vcan = true;
    kernel.has_no_carrier = true;
    fake_kernel_set_up(true);
    roadpose_socketcan_recover(&can, 5000000);
    expect_send(ROADPOSE_CAN_BUS_OFF);
    kernel.has_no_carrier = false;
    roadpose_socketcan_recover(&can, 5100000);
    expect_send(ROADPOSE_CAN_BUS_OFF);
    roadpose_socketcan_recover(&can, 7100000);
    expect_send(ROADPOSE_CAN_SENT);
}

static void what_is_closed_stays_closed(void) {
    open_vcan();
    roadpose_socketcan_close(&can);
    const int calls = kernel.calls;
    roadpose_socketcan_recover(&can, 0);
    expect_send(ROADPOSE_CAN_DOWN);
    roadpose_socketcan_close(&can);
    TEST_ASSERT_EQUAL_INT(calls, kernel.calls);
}

static void every_result_has_words(void) {
    for (int result = 0; result <= ROADPOSE_SOCKETCAN_REFUSED; result++)
        TEST_ASSERT_TRUE(strcmp(roadpose_socketcan_words((roadpose_socketcan_result_t)result), "unknown") != 0);
    TEST_ASSERT_EQUAL_STRING("unknown", roadpose_socketcan_words((roadpose_socketcan_result_t)99));
}

/* Opens, and sends an estimate in each cycle; the height names the cycle. */
static void drive(roadpose_can_context_t *output) {
    roadpose_can_transmit_t transmit;
    roadpose_can_estimate_t estimate;
    roadpose_can_output_init(output);
    (void)roadpose_can_output_add_bus(output, "vcan0");
    const roadpose_can_port_t port = roadpose_can_output_port(output);
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_DONE, roadpose_can_transmit_init(&transmit, NULL, &port));
    memset(&estimate, 0, sizeof estimate);
    estimate.pose.valid = ROADPOSE_CAN_HEIGHT;
    for (uint32_t cycle = 0; cycle < CYCLES; cycle++) {
        estimate.pose.height_um = 1000000 + 1250 * (int32_t)cycle;
        roadpose_can_transmit_publish(&transmit, &estimate, 0, cycle * 100000u);
        (void)roadpose_can_transmit_cycle(&transmit, cycle * 100000u);
        (void)roadpose_can_transmit_poll(&transmit, cycle * 100000u + 50000u);
    }
    (void)roadpose_can_output_close(output);
}

/* One system call fails, whichever, with whatever error: at most the frames of one cycle are missing, the last cycle is
 * complete unless it is the one hit, and no socket is left open. */
static void expect_little_lost(int fail_at) {
    roadpose_can_pose_t pose = {0, 0, 0, 0};
    int32_t newest = 0;
    TEST_ASSERT_EQUAL_INT(0, kernel.opened);
    TEST_ASSERT_TRUE(kernel.frames >= (int)(3u * CYCLES) - 4);
    for (int i = 0; i < kernel.frames; i++) {
        if (kernel.frame[i].id == 0x3D0) {
            roadpose_can_unpack_pose(kernel.frame[i].data, &pose);
            TEST_ASSERT_TRUE(pose.height_um > newest);
            newest = pose.height_um;
        }
    }
    if (fail_at < kernel.calls - 12)
        TEST_ASSERT_EQUAL_INT32(1000000 + 1250 * (int32_t)(CYCLES - 1u), newest);
}

static void any_call_may_fail_with_any_error(void) {
    static roadpose_can_context_t output;
    const int reasons[] = {ENOBUFS, EAGAIN, EINTR, ENETDOWN, ENXIO, ENODEV, EBADF, EIO, ENOMEM, EPERM};
    for (unsigned reason = 0; reason < sizeof reasons / sizeof reasons[0]; reason++) {
        int fail_at = 0;
        do {
            fail_at++;
            fake_kernel_init();
            kernel.fail_at = fail_at;
            kernel.fail_errno = reasons[reason];
            drive(&output);
            expect_little_lost(fail_at);
        } while (kernel.calls >= fail_at);
        TEST_ASSERT_EQUAL_INT(3 * (int)CYCLES, kernel.frames); /* the run that met no fault */
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(frames_reach_the_interface);
    RUN_TEST(the_socket_is_asked_for_what_it_needs);
    RUN_TEST(a_missing_interface_is_told_and_waited_for);
    RUN_TEST(a_kernel_without_can_is_told);
    RUN_TEST(names_that_no_interface_can_have_are_refused);
    RUN_TEST(a_full_queue_is_ordinary);
    RUN_TEST(an_interface_that_goes_down_and_up_is_used_again_at_once);
    RUN_TEST(an_error_kept_between_reading_and_writing_costs_no_frame);
    RUN_TEST(an_interface_that_vanishes_is_opened_again_when_it_comes_back);
    RUN_TEST(bus_off_lasts_until_the_restart);
    RUN_TEST(bus_off_ends_when_the_interface_is_taken_down);
    RUN_TEST(bus_off_that_is_heard_of_too_late_does_not_last_for_ever);
    RUN_TEST(bus_off_lasts_as_long_as_there_is_no_carrier);
    RUN_TEST(an_interface_that_is_bus_off_from_the_start_is_told);
    RUN_TEST(bus_off_ends_when_the_interface_vanishes);
    RUN_TEST(what_is_closed_stays_closed);
    RUN_TEST(every_result_has_words);
    RUN_TEST(any_call_may_fail_with_any_error);
    return UNITY_END();
}
