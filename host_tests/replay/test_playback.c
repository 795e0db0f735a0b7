/* roadpose-replay plays recordings of exact planes: the poses that it prints are the ones that were written. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "planar_recording.h"
#include "program.h"
#include "scratch.h"
#include "unity.h"

/* Samples in 1/256 px over some thousand points pin the plane down far better; a step of the paper's Method 2 that is
 * not refined is coarser. */
#define ANGLE_TOLERANCE_DEG 0.005
#define HEIGHT_TOLERANCE_M 0.0005

#define ROAD ((planar_pose_t){4.0, 2.0, 1.5})

static const planar_pose_t poses[] = {
    {0.0, 0.0, 1.5}, {3.0, 0.0, 1.2}, {-2.0, 5.0, 1.5}, {5.0, -12.0, 1.65}, {8.0, 20.0, 1.5}, {8.0, -20.0, 2.0},
};
#define POSE_COUNT (sizeof poses / sizeof *poses)

void setUp(void) {
    scratch_make();
}

void tearDown(void) {
    scratch_end(Unity.CurrentTestFailed);
}

/* The line after `index` others; the header is line 0. */
static const char *line_of(const char *output, int index) {
    for (; index > 0 && output != NULL; index--) {
        output = strchr(output, '\n');
        output = output != NULL ? output + 1 : NULL;
    }
    return output;
}

static void assert_frame_number(const program_run_t *run, int line, int number) {
    const char *text = line_of(run->output, line);
    char *end;

    TEST_ASSERT_NOT_NULL_MESSAGE(text, run->command);
    TEST_ASSERT_EQUAL_INT_MESSAGE(number, strtol(text, &end, 10), run->command);
    TEST_ASSERT_EQUAL_INT_MESSAGE(',', *end, run->command);
}

static void assert_pose(const program_run_t *run, int line, planar_pose_t truth) {
    const char *text = line_of(run->output, line);
    char status[32];
    double pitch, roll, height;

    TEST_ASSERT_EQUAL_STRING_MESSAGE("", run->errors, run->command);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, run->status, run->command);
    TEST_ASSERT_NOT_NULL_MESSAGE(text, run->command);
    TEST_ASSERT_EQUAL_INT_MESSAGE(4, sscanf(text, "%*d,%31[a-z_],%lf,%lf,%lf,,", status, &pitch, &roll, &height),
                                  run->command);
    TEST_ASSERT_EQUAL_STRING_MESSAGE("ok", status, run->command);
    TEST_ASSERT_TRUE_MESSAGE(fabs(pitch - truth.pitch_deg) <= ANGLE_TOLERANCE_DEG, text);
    TEST_ASSERT_TRUE_MESSAGE(fabs(roll - truth.roll_deg) <= ANGLE_TOLERANCE_DEG, text);
    TEST_ASSERT_TRUE_MESSAGE(fabs(height - truth.height_m) <= HEIGHT_TOLERANCE_M, text);
}

static void write_poses(const char *recording) {
    char name[32];

    planar_recording_begin(recording, PLANAR_RIG);
    for (size_t i = 0; i < POSE_COUNT; i++) {
        (void)snprintf(name, sizeof name, "%06u.pgm", (unsigned)i);
        planar_recording_add(recording, name, poses[i], PLANAR_Q8);
    }
}

static void test_poses_of_exact_planes(void) {
    program_run_t run;

    write_poses("planes");
    run = program_run(scratch_path("planes"), NULL);
    for (size_t i = 0; i < POSE_COUNT; i++) {
        assert_frame_number(&run, (int)i + 1, (int)i);
        assert_pose(&run, (int)i + 1, poses[i]);
    }
    TEST_ASSERT_EQUAL_STRING_MESSAGE("", line_of(run.output, (int)POSE_COUNT + 1), run.command);
    program_forget(&run);
}

static void test_the_same_bytes_twice(void) {
    program_run_t first, second;

    write_poses("planes");
    first = program_run("--points", "10", "--seed", "99", scratch_path("planes"), NULL);
    second = program_run("--points", "10", "--seed", "99", scratch_path("planes"), NULL);
    TEST_ASSERT_EQUAL_STRING_MESSAGE(first.output, second.output, second.command);
    program_forget(&first);
    program_forget(&second);
}

static void test_the_order_of_the_frames_does_not_matter(void) {
    program_run_t forward, backward;
    const char *first, *last;

    planar_recording_begin("forward", PLANAR_RIG);
    planar_recording_add("forward", "1.pgm", poses[1], PLANAR_Q8);
    planar_recording_add("forward", "2.pgm", poses[4], PLANAR_Q8);
    planar_recording_begin("backward", PLANAR_RIG);
    planar_recording_add("backward", "1.pgm", poses[4], PLANAR_Q8);
    planar_recording_add("backward", "2.pgm", poses[1], PLANAR_Q8);
    forward = program_run(scratch_path("forward"), NULL);
    backward = program_run(scratch_path("backward"), NULL);
    first = line_of(forward.output, 1);
    last = line_of(backward.output, 2);
    TEST_ASSERT_TRUE_MESSAGE(first != NULL && last != NULL, forward.command);
    /* From the comma after the frame number to the end of the line. */
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, strncmp(first + 1, last + 1, strcspn(first, "\n")), forward.command);
    program_forget(&forward);
    program_forget(&backward);
}

static void test_name_order_and_numbers(void) {
    program_run_t run;

    planar_recording_begin("drive", PLANAR_RIG);
    planar_recording_add("drive", "000012.pgm", ROAD, PLANAR_Q8);
    planar_recording_add("drive", "000007.pgm", ROAD, PLANAR_Q8);
    planar_recording_add("drive", "999999999.pgm", ROAD, PLANAR_Q8);
    scratch_write_text("drive/disparity/000008.txt", "not a frame");
    scratch_write_text("drive/disparity/.000009.pgm", "not a frame");
    run = program_run(scratch_path("drive"), NULL);
    assert_frame_number(&run, 1, 7);
    assert_frame_number(&run, 2, 12);
    assert_frame_number(&run, 3, 999999999);
    program_forget(&run);
}

static void test_names_that_are_no_numbers_count_from_0(void) {
    program_run_t run;

    planar_recording_begin("drive", PLANAR_RIG);
    planar_recording_add("drive", "left 5.pgm", ROAD, PLANAR_Q8);
    planar_recording_add("drive", "0000000010.pgm", ROAD, PLANAR_Q8); /* ten digits: may not fit 32 bits */
    run = program_run(scratch_path("drive"), NULL);
    assert_frame_number(&run, 1, 0);
    assert_frame_number(&run, 2, 1);
    assert_pose(&run, 2, ROAD);
    program_forget(&run);
}

static void play_samples(const char *recording, const char *rig_line, planar_samples_t samples) {
    char rig[512];
    program_run_t run;

    (void)snprintf(rig, sizeof rig, "%s%s", PLANAR_RIG, rig_line);
    planar_recording_begin(recording, rig);
    planar_recording_add(recording, "000000.pgm", ROAD, samples);
    run = program_run(scratch_path(recording), NULL);
    assert_pose(&run, 1, ROAD);
    program_forget(&run);
}

static void test_disparity_scales(void) {
    play_samples("q8", "disparity_scale: 256\n", PLANAR_Q8);
    play_samples("q9", "disparity_scale: 512.0\n", (planar_samples_t){512.0, 0.0, 0});
    play_samples("q4", "disparity_scale: 1.6e1\n", (planar_samples_t){16.0, 0.0, 0});
    play_samples("hundred", "disparity_scale: 100\n", (planar_samples_t){100.0, 0.0, 0});
    play_samples("fraction", "disparity_scale: 170.666666667\n", (planar_samples_t){170.666666667, 0.0, 0});
    play_samples("large", "disparity_scale: 1000\n", (planar_samples_t){1000.0, 0.0, 65535});
}

static void test_offset_and_invalid(void) {
    play_samples("offset", "disparity_offset_px: -0.5\n", (planar_samples_t){256.0, 0.5, 0});
    play_samples("scaled_offset", "disparity_offset_px: 0.25\ndisparity_scale: 200\n",
                 (planar_samples_t){200.0, -0.25, 0});
    play_samples("invalid", "invalid: 65535\n", (planar_samples_t){256.0, 0.0, 65535});
    play_samples("scaled_invalid", "invalid: 4000\ndisparity_scale: 300\n", (planar_samples_t){300.0, 0.0, 4000});
}

/* All that the format allows besides the plain lines: comments, blanks, line ends, unknown and nested keys. */
static void test_rig_file_in_other_clothes(void) {
    program_run_t run;

    planar_recording_begin("drive", "%YAML:1.0\r\n---\r\n# a comment\r\nwidth : 320   # pixels\r\n\r\nheight:240\r\n"
                                    "focal_px: 2.5000000000000000e+02\r\ncu_px:\t159.5\r\ncv_px: 119.5  \r\n"
                                    "camera: !!opencv-matrix\r\n   rows: 3\r\n   width: 7\r\n   data: [ 1, 2,\r\n"
                                    "       3 ]\r\nmaker: \"us: all\"\r\nrate_hz: 12.5\r\nbaseline_m: .3\r\n...");
    planar_recording_add("drive", "000000.pgm", ROAD, PLANAR_Q8);
    run = program_run(scratch_path("drive"), NULL);
    assert_pose(&run, 1, ROAD);
    program_forget(&run);
}

static void test_comments_in_a_frame_header(void) {
    program_run_t run;

    planar_recording_begin("drive", PLANAR_RIG);
    planar_recording_add_raw("drive", "000000.pgm", "P5 320 240 65535 ", 0, 2 * PLANAR_SAMPLES);
    planar_recording_add_raw("drive", "000001.pgm", "P5# one\n# two\n320 # three\n #four\n\t240\r\n#five\n65535\n", 0,
                             2 * PLANAR_SAMPLES);
    run = program_run(scratch_path("drive"), NULL);
    TEST_ASSERT_EQUAL_STRING_MESSAGE("0,no_disparity,,,,,,,,,,,,,,,,,,,,\n1,no_disparity,,,,,,,,,,,,,,,,,,,,\n", line_of(run.output, 1),
                                     run.command);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, run.status, run.command);
    program_forget(&run);
}

static void test_a_wall_is_no_road(void) {
    program_run_t run;

    planar_recording_begin("wall", PLANAR_RIG);
    planar_recording_add_raw("wall", "000000.pgm", "P5\n320 240\n65535\n", 20 * 256, 2 * PLANAR_SAMPLES);
    planar_recording_add_raw("wall", "000001.pgm", "P5\n320 240\n65535\n", 65535, 2 * PLANAR_SAMPLES);
    run = program_run(scratch_path("wall"), NULL);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, run.status, run.command);
    TEST_ASSERT_NULL_MESSAGE(strstr(run.output, ",ok,"), run.command);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(run.output, ",,,,,,,,,,,\n"), run.command);
    program_forget(&run);
}

static void play_blank_frame(const char *recording, unsigned width, unsigned height) {
    char rig[256], header[64];
    program_run_t run;

    (void)snprintf(rig, sizeof rig, "width: %u\nheight: %u\nfocal_px: 1000\ncu_px: 31\ncv_px: 31\nbaseline_m: 0.3\n",
                   width, height);
    (void)snprintf(header, sizeof header, "P5\n%u %u\n65535\n", width, height);
    planar_recording_begin(recording, rig);
    planar_recording_add_raw(recording, "000000.pgm", header, 0, 2 * width * height);
    run = program_run(scratch_path(recording), NULL);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, run.status, run.errors);
    TEST_ASSERT_EQUAL_STRING_MESSAGE("0,no_disparity,,,,,,,,,,,,,,,,,,,,\n", line_of(run.output, 1), run.command);
    program_forget(&run);
}

static void test_smallest_and_largest_frames(void) {
    play_blank_frame("small", 64, 64);
    play_blank_frame("large", 2048, 1536);
}

static void test_output_that_cannot_be_written(void) {
    program_run_t run;

    write_poses("planes");
    run = program_run_into("/dev/full", scratch_path("planes"), NULL);
    TEST_ASSERT_EQUAL_INT_MESSAGE(1, run.status, run.command);
    TEST_ASSERT_EQUAL_STRING_MESSAGE("roadpose-replay: standard output: cannot be written: No space left on device\n",
                                     run.errors, run.command);
    program_forget(&run);
}

static void test_progress_on_a_terminal_only(void) {
    program_run_t run;

    write_poses("planes");
    run = program_run_on_terminal(scratch_path("planes"), NULL);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, run.status, run.command);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(run.errors, "\r1 of 6 frames"), run.errors);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(run.errors, "\r6 of 6 frames\r\033[K"), run.errors);
    TEST_ASSERT_NULL_MESSAGE(strchr(run.errors, '\n'), run.errors);
    TEST_ASSERT_NOT_NULL_MESSAGE(line_of(run.output, (int)POSE_COUNT + 1), run.command);
    program_forget(&run);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_poses_of_exact_planes);
    RUN_TEST(test_the_same_bytes_twice);
    RUN_TEST(test_the_order_of_the_frames_does_not_matter);
    RUN_TEST(test_name_order_and_numbers);
    RUN_TEST(test_names_that_are_no_numbers_count_from_0);
    RUN_TEST(test_disparity_scales);
    RUN_TEST(test_offset_and_invalid);
    RUN_TEST(test_rig_file_in_other_clothes);
    RUN_TEST(test_comments_in_a_frame_header);
    RUN_TEST(test_a_wall_is_no_road);
    RUN_TEST(test_smallest_and_largest_frames);
    RUN_TEST(test_output_that_cannot_be_written);
    RUN_TEST(test_progress_on_a_terminal_only);
    return UNITY_END();
}
