/* The bus fails in every way at every call. A run of cycles is repeated: sending fails at call N, for N = 1, 2, ...
 * until a run completes without meeting the fault. After every run the bus must show: frames of a cycle in order,
 * counters that go on where the bus was only full, and in every cycle the newest estimate or nothing. */
#include <stdio.h>
#include <string.h>

#include "fake_bus.h"
#include "unity.h"

#define CYCLE_US 20000u
#define CYCLES 40u
#define POLLS 3u

static roadpose_can_context_t bus;
static roadpose_can_transmit_t transmit;
static unsigned first_call[CYCLES + 1]; /* of can_send in this cycle, counted from 1 */

typedef struct {
    roadpose_can_send_t with;
    unsigned calls; /* how many calls fail in a row */
    bool needs_recover;
} fault_t;

void setUp(void) {
}

void tearDown(void) {
}

/* The height names the cycle: 1.25 mm a cycle. */
static int32_t height_of(unsigned cycle) {
    return 1000000 + 1250 * (int32_t)cycle;
}

static void publish(unsigned cycle, uint64_t now_us) {
    roadpose_can_estimate_t estimate;
    memset(&estimate, 0, sizeof estimate);
    estimate.pose.valid = ROADPOSE_CAN_HEIGHT;
    estimate.pose.height_um = height_of(cycle);
    roadpose_can_transmit_publish(&transmit, &estimate, 0, now_us);
}

/* One drive. Returns whether the fault was met. */
static bool drive(const fault_t *fault, unsigned fail_at) {
    const roadpose_can_port_t port = fake_bus_port(&bus);
    fake_bus_init(&bus);
    bus.fail_from = fail_at;
    bus.fail_to = fail_at + fault->calls - 1u;
    bus.fail_with = fault->with;
    bus.needs_recover = fault->needs_recover;
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_DONE, roadpose_can_transmit_init(&transmit, NULL, &port));
    transmit.settings.cycle_us = CYCLE_US;
    for (unsigned cycle = 0; cycle < CYCLES; cycle++) {
        const uint64_t now_us = (uint64_t)cycle * CYCLE_US;
        first_call[cycle] = bus.sends + 1u;
        publish(cycle, now_us);
        (void)roadpose_can_transmit_cycle(&transmit, now_us);
        for (unsigned poll = 1; poll <= POLLS; poll++)
            (void)roadpose_can_transmit_poll(&transmit, now_us + poll * (CYCLE_US / (POLLS + 1u)));
    }
    first_call[CYCLES] = bus.sends + 1u;
    return bus.sends >= fail_at;
}

static unsigned cycle_of(const fake_frame_t *frame) {
    unsigned cycle = 0;
    while (frame->call >= first_call[cycle + 1u])
        cycle++;
    return cycle;
}

/* No frame is older than the cycle in which it was taken, and none belongs to another cycle. */
static void expect_newest(void) {
    for (unsigned i = 0; i < bus.frames; i++) {
        const unsigned cycle = cycle_of(&bus.frame[i]);
        TEST_ASSERT_TRUE(bus.frame[i].deadline_us == (uint64_t)(cycle + 1u) * CYCLE_US);
        if (bus.frame[i].id == 0x3D0) {
            roadpose_can_pose_t pose;
            roadpose_can_unpack_pose(bus.frame[i].data, &pose);
            TEST_ASSERT_EQUAL_INT32(height_of(cycle), pose.height_um);
        }
    }
}

static const fake_frame_t *frame_in(uint32_t id, unsigned cycle) {
    for (unsigned i = 0; i < bus.frames; i++) {
        if (bus.frame[i].id == id && cycle_of(&bus.frame[i]) == cycle)
            return &bus.frame[i];
    }
    return NULL;
}

/* Counters of one message: one more with each frame; where the bus was down also with each cycle that was lost, but
 * never again the value of the last frame that was sent. */
static void expect_counters(uint32_t id, bool bus_was_down) {
    unsigned expected = ROADPOSE_E2E_FIRST_COUNTER;
    unsigned last = 99;
    for (unsigned cycle = 0; cycle < CYCLES; cycle++) {
        const fake_frame_t *frame = frame_in(id, cycle);
        if (frame != NULL) {
            TEST_ASSERT_EQUAL_UINT8(expected, fake_frame_counter(frame));
            last = expected;
        }
        if (frame != NULL || bus_was_down)
            expected = (expected + 1u) % 15u;
        if (expected == last)
            expected = (expected + 1u) % 15u;
    }
}

static void expect_receivable(void) {
    roadpose_can_receive_t receive;
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_DONE, roadpose_can_receive_init(&receive, NULL));
    for (unsigned i = 0; i < bus.frames; i++) {
        const roadpose_can_message_t message =
            roadpose_can_receive_frame(&receive, bus.frame[i].id, bus.frame[i].data, 8);
        TEST_ASSERT_TRUE(message != ROADPOSE_CAN_MESSAGE_NONE);
        TEST_ASSERT_TRUE(receive.view.e2e[message] != ROADPOSE_E2E_CRC_ERROR);
        TEST_ASSERT_TRUE(receive.view.e2e[message] != ROADPOSE_E2E_REPEATED);
    }
}

static void expect_counts(void) {
    const roadpose_can_counts_t *counts = roadpose_can_transmit_counts(&transmit);
    unsigned waiting = 0;
    for (unsigned message = 0; message < ROADPOSE_CAN_MESSAGES; message++)
        waiting += transmit.slot[message].waits ? 1u : 0u;
    TEST_ASSERT_EQUAL_UINT32(bus.frames, counts->sent);
    TEST_ASSERT_EQUAL_UINT32(3u * CYCLES, counts->sent + counts->dropped + waiting);
    TEST_ASSERT_TRUE(counts->recovered == counts->down || counts->recovered + 1u == counts->down);
}

/* After the fault has passed, everything of the last cycle is on the bus. */
static void expect_recovered(unsigned fail_at, const fault_t *fault) {
    if (fail_at + fault->calls < first_call[CYCLES - 1u]) {
        TEST_ASSERT_EQUAL_UINT(CYCLES - 1u, cycle_of(&bus.frame[bus.frames - 1u]));
        TEST_ASSERT_EQUAL_HEX32(0x3D2, bus.frame[bus.frames - 1u].id);
        TEST_ASSERT_FALSE(transmit.bus_down);
    }
}

static void fail_at_every_call(const fault_t *fault) {
    const bool down = fault->with != ROADPOSE_CAN_FULL;
    bool met = true;
    for (unsigned fail_at = 1; met; fail_at++) {
        met = drive(fault, fail_at);
        expect_newest();
        for (uint32_t id = 0x3D0; id <= 0x3D2; id++)
            expect_counters(id, down);
        expect_receivable();
        expect_counts();
        expect_recovered(fail_at, fault);
        if (!met)
            TEST_ASSERT_EQUAL_UINT(3u * CYCLES, bus.frames);
    }
}

static void one_call_is_full(void) {
    const fault_t fault = {ROADPOSE_CAN_FULL, 1, false};
    fail_at_every_call(&fault);
    TEST_ASSERT_EQUAL_UINT32(0, roadpose_can_transmit_counts(&transmit)->dropped);
}

static void the_queue_is_full_for_any_time(void) {
    for (unsigned calls = 2; calls <= 60; calls++) {
        const fault_t fault = {ROADPOSE_CAN_FULL, calls, false};
        fail_at_every_call(&fault);
    }
}

static void the_bus_is_down_for_any_time(void) {
    for (unsigned calls = 1; calls <= 60; calls++) {
        const fault_t fault = {ROADPOSE_CAN_DOWN, calls, false};
        fail_at_every_call(&fault);
    }
}

static void the_bus_is_off_until_it_is_recovered(void) {
    const fault_t fault = {ROADPOSE_CAN_BUS_OFF, 1, true};
    fail_at_every_call(&fault);
    TEST_ASSERT_TRUE(drive(&fault, 10));
    TEST_ASSERT_EQUAL_UINT(1, bus.recovers);
    TEST_ASSERT_EQUAL_UINT32(1, roadpose_can_transmit_counts(&transmit)->down);
    TEST_ASSERT_EQUAL_UINT32(1, roadpose_can_transmit_counts(&transmit)->bus_off);
    TEST_ASSERT_EQUAL_UINT32(1, roadpose_can_transmit_counts(&transmit)->recovered);
}

static void an_answer_that_does_not_exist_is_a_dead_bus(void) {
    const fault_t fault = {(roadpose_can_send_t)-77, 1, true};
    fail_at_every_call(&fault);
}

static void a_port_without_recover_is_served_too(void) {
    const fault_t fault = {ROADPOSE_CAN_DOWN, 7, false};
    roadpose_can_port_t port = fake_bus_port(&bus);
    port.can_recover = NULL;
    fake_bus_init(&bus);
    bus.fail_from = 1;
    bus.fail_to = fault.calls;
    bus.fail_with = fault.with;
    TEST_ASSERT_EQUAL_INT(ROADPOSE_CAN_DONE, roadpose_can_transmit_init(&transmit, NULL, &port));
    for (unsigned cycle = 0; cycle < 20; cycle++)
        (void)roadpose_can_transmit_cycle(&transmit, cycle * 100000u);
    TEST_ASSERT_EQUAL_UINT(13u * 3u, bus.frames);
    TEST_ASSERT_EQUAL_UINT32(7u * 3u, roadpose_can_transmit_counts(&transmit)->dropped);
}

static void a_call_never_sends_more_than_three(void) {
    const fault_t fault = {ROADPOSE_CAN_FULL, 100000, false};
    (void)drive(&fault, 5);
    TEST_ASSERT_EQUAL_UINT(4, bus.frames);
    TEST_ASSERT_EQUAL_UINT(4u + 1u + POLLS + (CYCLES - 2u) * (1u + POLLS), bus.sends);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(one_call_is_full);
    RUN_TEST(the_queue_is_full_for_any_time);
    RUN_TEST(the_bus_is_down_for_any_time);
    RUN_TEST(the_bus_is_off_until_it_is_recovered);
    RUN_TEST(an_answer_that_does_not_exist_is_a_dead_bus);
    RUN_TEST(a_port_without_recover_is_served_too);
    RUN_TEST(a_call_never_sends_more_than_three);
    return UNITY_END();
}
