/* What yaw must reach, on simulated drives with random seeds: straight ones against a double-precision weighted least
 * squares on the true matches, turning ones, standing ones. Prints the tables of docs/heading.md. */
#include <math.h>
#include <stdio.h>

#include "drive_simulation.h"
#include "roadpose/heading.h"
#include "unity.h"

#define DRIVES 20
#define FRAMES 30
#define TURNING_FRAMES 4000

static random_numbers_t numbers;
static roadpose_heading_t heading;
static simulated_tracks_t tracks;

void setUp(void) {}
void tearDown(void) {}

typedef struct {
    int frames, accepted, far_off; /* far off: by more than 0.8 degrees */
    double error, reference, worst, running, running_worst;
} score_t;

static simulated_mount_t any_mount(void) {
    simulated_mount_t mount;
    mount.pitch = radians_of(random_double(&numbers, -5, 8));
    mount.roll = radians_of(random_double(&numbers, -10, 10));
    mount.yaw = radians_of(random_double(&numbers, -5, 5));
    mount.height_m = random_double(&numbers, 1.2, 1.8);
    return mount;
}

static roadpose_yaw_t process(const simulated_mount_t *mount, const simulated_step_t *step, const roadpose_motion_t *motion) {
    roadpose_track_t library[SIMULATION_TRACKS_MAX];
    int32_t normal[3];
    roadpose_yaw_t yaw;
    simulate_tracks(&tracks, &SIMULATED_RIG, mount, step, &numbers);
    library_tracks(&tracks, &SIMULATED_RIG, library);
    mount_normal_q30(mount, normal);
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_heading_process(&heading, library, (size_t)tracks.count, motion, normal, &yaw));
    return yaw;
}

static double reference_error(const simulated_mount_t *mount) {
    double normal[3], truth[2], focus[2];
    mount_normal(mount, normal);
    mount_focus(mount, SIMULATED_RIG.focal_px, truth);
    reference_focus(&tracks, truth, focus);
    return fabs(degrees_of(yaw_of_focus(focus, SIMULATED_RIG.focal_px, normal) - mount->yaw));
}

static void start_drive(void) {
    const roadpose_rig_t rig = library_rig(&SIMULATED_RIG);
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_heading_init(&heading, &rig, NULL));
}

static void add_frame(score_t *score, const simulated_mount_t *mount, const roadpose_yaw_t *yaw) {
    score->frames++;
    if (yaw->status != ROADPOSE_YAW_OK) return;
    const double error = fabs(degrees_of(1e-6 * yaw->yaw_urad - mount->yaw));
    score->accepted++;
    score->error += error;
    score->reference += reference_error(mount);
    score->worst = fmax(score->worst, error);
    score->far_off += error > 0.8;
}

/* One drive, straight unless rate_deg_s says otherwise; its running yaw at the end. */
static void drive(score_t *score, double noise, double outliers, int count, double rate_deg_s, bool told) {
    const simulated_mount_t mount = any_mount();
    roadpose_running_yaw_t running;
    start_drive();
    for (int frame = 0; frame < FRAMES; frame++) {
        const double moved = random_double(&numbers, 0.8, 1.5), turn = radians_of(rate_deg_s / 10);
        const simulated_step_t step = {moved, turn, noise, outliers, count};
        const roadpose_motion_t motion = {.interval_us = 100000, .has_speed = told, .has_yaw_rate = told,
                                          .speed_mm_s = (int32_t)(moved * 1e4),
                                          .yaw_rate_urad_s = (int32_t)lround(turn * 1e7)};
        const roadpose_yaw_t yaw = process(&mount, &step, &motion);
        add_frame(score, &mount, &yaw);
    }
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_heading_running(&heading, &running));
    const double error = fabs(degrees_of(1e-6 * running.yaw_urad - mount.yaw));
    if (running.count > 0) score->running += error / DRIVES;
    if (running.count > 0) score->running_worst = fmax(score->running_worst, error);
}

static void print_score(const char *what, const score_t *s) {
    printf("| %s | %d | %.3f | %.3f | %.2f | %.2f | %.2f %% | %.3f | %.3f |\n", what, s->accepted * 100 / s->frames,
           s->error / s->accepted, s->reference / s->accepted, s->error / s->reference, s->worst,
           100.0 * s->far_off / s->accepted, s->running, s->running_worst);
}

#define SCORE_HEAD                                                                                                       \
    "| accepted, %% | mean error | reference | ratio | worst | over 0.8 | running, mean | running, worst |\n"            \
    "|---|---|---|---|---|---|---|---|---|\n"

static void straight_drives_at(double outliers, int count) {
    static const double noises[] = {0.1, 0.2, 0.3, 0.4, 0.5};
    score_t all = {0};
    for (int i = 0; i < 5; i++) {
        score_t score = {0};
        char what[64];
        for (int k = 0; k < DRIVES; k++) drive(&score, noises[i], outliers, count, 0, false);
        snprintf(what, sizeof what, "%d tracks, %.0f %% outliers, %.1f px", count, 100 * outliers, noises[i]);
        print_score(what, &score);
        TEST_ASSERT_GREATER_THAN(score.frames / 3, score.accepted);
        TEST_ASSERT_TRUE_MESSAGE(score.error / score.accepted <= 0.2, "mean error over 0.2 degrees");
        TEST_ASSERT_TRUE_MESSAGE(score.error <= 1.5 * score.reference, "over 1.5 times the reference");
        TEST_ASSERT_TRUE_MESSAGE(score.running <= 0.05, "running yaw over 0.05 degrees");
        all.error += score.error;
        all.reference += score.reference;
        all.accepted += score.accepted;
        all.far_off += score.far_off;
    }
    TEST_ASSERT_TRUE(all.far_off * 100 <= 2 * all.accepted);
    printf("| all of these | | | | %.2f | | | | |\n", all.error / all.reference);
}

static void test_straight_drives(void) {
    static const double shares[] = {0, 0.2, 0.4, 0.5};
    printf("\n| straight, degrees " SCORE_HEAD);
    for (int i = 0; i < 4; i++) straight_drives_at(shares[i], 200);
    straight_drives_at(0.3, 120);
}

/* Below the limit of the gate a turn is seen and taken into account, or told by the vehicle. */
static void test_mild_turns(void) {
    printf("\n| yaw rate, deg/s " SCORE_HEAD);
    for (int told = 0; told < 2; told++) {
        score_t all = {0};
        for (int rate = 0; rate < 4; rate++) {
            score_t score = {0};
            char what[64];
            for (int k = 0; k < DRIVES; k++)
                drive(&score, random_double(&numbers, 0.1, 0.5), random_double(&numbers, 0, 0.5), 200,
                      (k & 1 ? 1 : -1) * 0.8 * rate, told);
            snprintf(what, sizeof what, "%.1f, %s", 0.8 * rate, told ? "told" : "not told");
            print_score(what, &score);
            all.far_off += score.far_off;
            all.accepted += score.accepted;
            TEST_ASSERT_TRUE_MESSAGE(score.error / score.accepted <= (told ? 0.1 : 0.3), "mean error too large");
        }
        TEST_ASSERT_TRUE_MESSAGE(all.far_off * 100 <= 2 * all.accepted, "too many accepted frames far off");
    }
}

static void sharp_turns(bool told, int *by_status) {
    for (int i = 0; i < TURNING_FRAMES; i++) {
        const simulated_mount_t mount = any_mount();
        const double rate = random_double(&numbers, 5, 30) * (i & 1 ? 1 : -1);
        const simulated_step_t step = {random_double(&numbers, 0.3, 1.5), radians_of(rate / 10),
                                       random_double(&numbers, 0.1, 0.5), random_double(&numbers, 0, 0.5),
                                       (int)random_between(&numbers, 60, 300)};
        const roadpose_motion_t motion = {.interval_us = 100000, .has_yaw_rate = told,
                                          .yaw_rate_urad_s = (int32_t)lround(radians_of(rate) * 1e6)};
        start_drive();
        by_status[process(&mount, &step, &motion).status]++;
    }
}

static void test_no_yaw_in_sharp_turns(void) {
    for (int told = 0; told < 2; told++) {
        int by_status[ROADPOSE_YAW_STATUS_COUNT] = {0};
        sharp_turns(told, by_status);
        printf("\nturns of 5...30 deg/s, yaw rate %s:", told ? "told" : "not told");
        for (int i = 0; i < ROADPOSE_YAW_STATUS_COUNT; i++)
            if (by_status[i]) printf(" %s %d", roadpose_yaw_status_word((uint8_t)i), by_status[i]);
        printf("\n");
        TEST_ASSERT_EQUAL_MESSAGE(0, by_status[ROADPOSE_YAW_OK], "a yaw was accepted in a turn");
    }
}

/* Without a speed: the tracks of a car that stands among others that move. */
static void test_no_yaw_when_standing(void) {
    for (int i = 0; i < 1000; i++) {
        const simulated_mount_t mount = any_mount();
        const simulated_step_t step = {0, 0, random_double(&numbers, 0.1, 0.5), random_double(&numbers, 0, 0.5), 200};
        start_drive();
        TEST_ASSERT_NOT_EQUAL(ROADPOSE_YAW_OK, process(&mount, &step, NULL).status);
    }
}

static void test_vehicle_gates(void) {
    const simulated_mount_t mount = {0, 0, 0.02, 1.5};
    const simulated_step_t step = {1.2, 0, 0.2, 0, 200};
    roadpose_motion_t motion = {.interval_us = 100000, .has_speed = true, .speed_mm_s = 12000};
    start_drive();
    TEST_ASSERT_EQUAL(ROADPOSE_YAW_OK, process(&mount, &step, &motion).status);
    motion.speed_mm_s = 2900;
    TEST_ASSERT_EQUAL(ROADPOSE_YAW_SLOW, process(&mount, &step, &motion).status);
    motion.speed_mm_s = -12000;
    TEST_ASSERT_EQUAL(ROADPOSE_YAW_SLOW, process(&mount, &step, &motion).status);
    motion = (roadpose_motion_t){.interval_us = 100000, .has_yaw_rate = true, .yaw_rate_urad_s = 61088};
    TEST_ASSERT_EQUAL(ROADPOSE_YAW_TURNING, process(&mount, &step, &motion).status);
}

/* A camera 0.4 degrees off in pitch by its disparity map: the motion says so. */
static void test_second_opinion_on_pitch(void) {
    const simulated_mount_t mount = {radians_of(2), radians_of(4), radians_of(-3), 1.5};
    simulated_mount_t biased = mount;
    double sum = 0;
    biased.pitch += radians_of(0.4);
    start_drive();
    for (int i = 0; i < 50; i++) {
        const simulated_step_t step = {1.2, 0, 0.2, 0.2, 200};
        roadpose_track_t library[SIMULATION_TRACKS_MAX];
        roadpose_yaw_t yaw;
        int32_t normal[3];
        simulate_tracks(&tracks, &SIMULATED_RIG, &mount, &step, &numbers);
        library_tracks(&tracks, &SIMULATED_RIG, library);
        mount_normal_q30(&biased, normal);
        roadpose_heading_process(&heading, library, (size_t)tracks.count, NULL, normal, &yaw);
        TEST_ASSERT_EQUAL(ROADPOSE_YAW_OK, yaw.status);
        TEST_ASSERT_INT_WITHIN(2, (int)lround(1e6 * biased.pitch), yaw.pitch_motion_urad + yaw.pitch_difference_urad);
        sum += degrees_of(1e-6 * yaw.pitch_difference_urad) / 50;
    }
    printf("\npitch of the plane minus pitch of motion, 0.4 degrees of bias: %.3f\n", sum);
    TEST_ASSERT_TRUE(fabs(sum - 0.4) <= 0.02);
}

/* A street with a wall on one side: of the tracks on the other side three in four are missing. */
static void drop_left_tracks(void) {
    int kept = 0;
    for (int i = 0; i < tracks.count; i++)
        if (tracks.track[i].u0 > 0 || i % 4 == 0) tracks.track[kept++] = tracks.track[i];
    tracks.count = kept;
}

static double lopsided_frame_error(const simulated_mount_t *mount, double noise_px, int *accepted) {
    const double turn = radians_of(random_double(&numbers, -0.15, 0.15));
    const simulated_step_t step = {1.2, turn, noise_px, 0, 400};
    const roadpose_motion_t motion = {.interval_us = 100000};
    roadpose_track_t library[SIMULATION_TRACKS_MAX];
    roadpose_yaw_t yaw;
    int32_t normal[3];
    simulate_tracks(&tracks, &SIMULATED_RIG, mount, &step, &numbers);
    drop_left_tracks();
    library_tracks(&tracks, &SIMULATED_RIG, library);
    mount_normal_q30(mount, normal);
    roadpose_heading_process(&heading, library, (size_t)tracks.count, &motion, normal, &yaw);
    *accepted += yaw.status == ROADPOSE_YAW_OK;
    return (yaw.status == ROADPOSE_YAW_OK) ? degrees_of(1e-6 * yaw.yaw_urad - mount->yaw) : 0;
}

/* The mean error keeps its sign: the noise must not draw the focus to the side where the tracks are. */
static void test_lopsided_tracks(void) {
    const simulated_mount_t mount = {radians_of(1), 0, 0, 1.5};
    double sum = 0;
    int accepted = 0;
    start_drive();
    for (int i = 0; i < 2000; i++) sum += lopsided_frame_error(&mount, 0.4, &accepted);
    printf("\ntracks on one side, 0.4 px: mean error with its sign %.3f (%d of 2000 accepted)\n", sum / accepted, accepted);
    TEST_ASSERT_GREATER_THAN(1000, accepted);
    TEST_ASSERT_TRUE_MESSAGE(fabs(sum / accepted) <= 0.05, "focus drawn to one side by over 0.05 degrees");
}

int main(void) {
    numbers = random_numbers("simulated drives");
    UNITY_BEGIN();
    RUN_TEST(test_straight_drives);
    RUN_TEST(test_mild_turns);
    RUN_TEST(test_no_yaw_in_sharp_turns);
    RUN_TEST(test_no_yaw_when_standing);
    RUN_TEST(test_vehicle_gates);
    RUN_TEST(test_second_opinion_on_pitch);
    RUN_TEST(test_lopsided_tracks);
    return UNITY_END();
}
