/* A kerb within the corridor is not the road: it may cost support, or the pose, but must not turn the plane. */
#include <stdio.h>
#include <stdlib.h>

#include "random_numbers.h"
#include "roadpose/roadpose.h"
#include "synthetic.h"
#include "unity.h"

enum { PIXELS = 640 * 480, TRIES = 200 };

static roadpose_t instance;
static uint16_t image[PIXELS];

/* Everything further than `lateral_m` to one side (negative: left) lies `step_m` higher: that plane is nearer. */
static void raise_side(const roadpose_rig_t *rig, true_pose_t pose, double lateral_m, double step_m) {
    const true_pose_t raised = {pose.pitch_deg, pose.roll_deg, pose.height_m - step_m};
    const true_plane_t plane = true_plane_of(rig, raised);
    for (int v = 0; v < 480; v++) {
        for (int u = 0; u < 640; u++) {
            const double d = true_disparity_at(rig, plane, u, v);
            const double x = d > 0.5 ? (u - 319.5) * 0.30 / d : 0; /* sideways in camera axes; the roll is small */
            const bool beyond = lateral_m < 0 ? x < lateral_m : x > lateral_m;
            if (d > 0.5 && d < 128 && beyond) image[v * 640 + u] = (uint16_t)(d * 256 + 0.5);
        }
    }
}

static void add_noise(random_numbers_t *numbers, double sigma_px) {
    for (int i = 0; i < PIXELS; i++) {
        const double noisy = image[i] + 256 * sigma_px * random_normal(numbers);
        if (image[i]) image[i] = (uint16_t)(noisy < 1 ? 1 : noisy > 32767 ? 32767 : noisy);
    }
}

void setUp(void) {
}

void tearDown(void) {
}

static void test_a_kerb_on_one_side_does_not_turn_the_plane(void) {
    random_numbers_t numbers = random_numbers("kerb");
    const roadpose_rig_t rig = rig_640x480();
    const roadpose_disparity_format_t format = format_u16_q8();
    int accepted = 0;
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_init(&instance, &rig, &format, NULL));
    for (int i = 0; i < TRIES; i++) {
        const true_pose_t pose = {random_double(&numbers, -2, 4), random_double(&numbers, -2, 2),
                                  random_double(&numbers, 1.2, 1.8)};
        const double side = i % 2 == 0 ? -1 : 1;
        const double lateral_m = side * random_double(&numbers, 1.0, 1.9), step_m = random_double(&numbers, 0.05, 0.15);
        const roadpose_frame_t frame = frame_of(&rig, image);
        roadpose_pose_t estimate;
        render_road(&rig, pose, 128, image);
        raise_side(&rig, pose, lateral_m, step_m);
        add_noise(&numbers, 0.15);
        TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_process(&instance, &frame, &estimate));
        if (estimate.status != ROADPOSE_STATUS_OK) continue;
        accepted++;
        char what[120];
        snprintf(what, sizeof what, "try %d: kerb %.3f m high at %.2f m, pitch %.2f roll %.2f height %.2f", i, step_m,
                 lateral_m, pose.pitch_deg, pose.roll_deg, pose.height_m);
        TEST_ASSERT_INT32_WITHIN_MESSAGE(8727, (int32_t)(pose.roll_deg * 17453.29), estimate.roll_urad, what);
        TEST_ASSERT_INT32_WITHIN_MESSAGE(8727, (int32_t)(pose.pitch_deg * 17453.29), estimate.pitch_urad, what);
        TEST_ASSERT_INT32_WITHIN_MESSAGE(50000, (int32_t)(pose.height_m * 1e6), estimate.height_um, what);
    }
    TEST_ASSERT_GREATER_THAN(TRIES / 2, accepted);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_a_kerb_on_one_side_does_not_turn_the_plane);
    return UNITY_END();
}
