/* The camera port against an interrupt at every point: first at each place where the port calls out or returns, alone
 * and in pairs. Between those places the port touches nothing that both sides share unless it holds the lock: the
 * driver of these tests hides it. */
#include <stdio.h>

#include "camera_driver.h"
#include "unity.h"

static roadpose_camera_context_t driver;
static const char *current; /* what a failure prints: the points of the run */
static char points[128];

void setUp(void) {
    current = "";
}

void tearDown(void) {
    if (Unity.CurrentTestFailed)
        (void)printf("\nin the run with %s\n", current);
}

/* One run: a frame, then cycles of some slices, a flush in the midst if asked for, until nothing is left. Returns how
 * many interrupt points it had. */
static uint32_t run(uint32_t first, uint32_t second, frame_kind_t kind, uint32_t slices, uint32_t flush_after) {
    roadpose_camera_progress_t progress;
    uint32_t cycle = 0;

    (void)snprintf(points, sizeof points, "interrupts at %lu and %lu, kind %d, %lu slices a cycle, flush after %lu",
                   (unsigned long)first, (unsigned long)second, (int)kind, (unsigned long)slices,
                   (unsigned long)flush_after);
    current = points;
    driver_start(&driver);
    driver_interrupt(&driver, FRAME_GOOD);
    driver.strike[0] = first;
    driver.strike[1] = second;
    driver.strike_kind = kind;
    do {
        progress = roadpose_camera_task(&driver.port, slices);
        driver_pass_point(&driver);
        if (++cycle == flush_after)
            roadpose_camera_flush(&driver.port);
        TEST_ASSERT_TRUE_MESSAGE(cycle <= 4 * roadpose_slices_max() + 8, "the port is stuck");
    } while (progress != ROADPOSE_CAMERA_IDLE);
    driver_stop(&driver);
    return driver.point;
}

static void strike_everywhere(uint32_t slices, uint32_t flush_after) {
    for (int kind = 0; kind < FRAME_KINDS; kind++) {
        uint32_t first = 0;

        while (first < run(first, DRIVER_NEVER, (frame_kind_t)kind, slices, flush_after))
            first++;
        TEST_ASSERT_TRUE_MESSAGE(first > 10, "there were hardly any points");
    }
}

static void test_one_interrupt_at_every_point(void) {
    strike_everywhere(1, DRIVER_NEVER);
    strike_everywhere(UINT32_MAX, DRIVER_NEVER);
}

static void test_one_interrupt_at_every_point_around_a_flush(void) {
    for (uint32_t cycle = 1; cycle < 4; cycle++)
        strike_everywhere(1, cycle);
}

static void test_two_interrupts_at_every_pair_of_points(void) {
    for (int kind = 0; kind <= FRAME_WRONG_SIZE; kind++) {
        uint32_t first = 0, total = 1;

        for (; first < total; first++) {
            uint32_t second = first + 1;

            while (second < (total = run(first, second, (frame_kind_t)kind, 8, DRIVER_NEVER)))
                second++;
        }
        TEST_ASSERT_TRUE_MESSAGE(first > 10, "there were hardly any points");
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_one_interrupt_at_every_point);
    RUN_TEST(test_one_interrupt_at_every_point_around_a_flush);
    RUN_TEST(test_two_interrupts_at_every_pair_of_points);
    return UNITY_END();
}
