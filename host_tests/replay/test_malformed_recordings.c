/* Malformed recordings: exit 3, one line that names file and fault, and the lines already printed stay valid. */
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "planar_recording.h"
#include "program.h"
#include "scratch.h"
#include "unity.h"

#define ROAD ((planar_pose_t){4.0, 2.0, 1.5})
#define HEADER "P5\n320 240\n65535\n"
#define FRAME_BYTES (2u * PLANAR_SAMPLES)

void setUp(void) {
    scratch_make();
}

void tearDown(void) {
    scratch_end(Unity.CurrentTestFailed);
}

static int count_lines(const char *text) {
    int lines = 0;

    for (; *text != '\0'; text++)
        lines += *text == '\n' ? 1 : 0;
    return lines;
}

/* lines: of standard output, header included. */
static void assert_fault(const char *file, const char *reason, int lines) {
    program_run_t run = program_run(scratch_path("drive"), NULL);

    TEST_ASSERT_EQUAL_INT_MESSAGE(3, run.status, run.command);
    TEST_ASSERT_EQUAL_INT_MESSAGE(1, count_lines(run.errors), run.errors);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(run.errors, file), run.errors);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(run.errors, reason), run.errors);
    TEST_ASSERT_EQUAL_INT_MESSAGE(lines, count_lines(run.output), run.command);
    program_forget(&run);
}

static void assert_rig_fault(const char *rig, const char *reason) {
    scratch_write_text("drive/rig.yml", rig);
    assert_fault("drive/rig.yml: ", reason, 0);
}

static void begin_drive(void) {
    planar_recording_begin("drive", PLANAR_RIG);
    planar_recording_add("drive", "000000.pgm", ROAD, PLANAR_Q8);
}

/* PLANAR_RIG with the line of one key exchanged ("" takes it away). */
static const char *rig_with(const char *key, const char *line) {
    static char rig[1024];
    static const char whole[] = PLANAR_RIG;
    const char *old = strstr(whole, key);
    const char *rest = old != NULL ? strchr(old, '\n') + 1 : whole + strlen(whole);

    old = old != NULL ? old : rest;
    (void)snprintf(rig, sizeof rig, "%.*s%s%s%s", (int)(old - whole), whole, line, *line != '\0' ? "\n" : "", rest);
    return rig;
}

static void test_no_recording_at_all(void) {
    assert_fault("drive/rig.yml: ", "cannot be read: No such file", 0);
}

static void test_no_rig(void) {
    begin_drive();
    scratch_remove("drive/rig.yml");
    assert_fault("drive/rig.yml: ", "cannot be read: No such file", 0);
}

static void test_a_folder_instead_of_a_rig(void) {
    begin_drive();
    scratch_remove("drive/rig.yml");
    scratch_make_folder("drive/rig.yml");
    assert_fault("drive/rig.yml: ", "cannot be read: Is a directory", 0);
}

static void test_missing_keys(void) {
    static const char *const keys[] = {"width", "height", "focal_px", "cu_px", "cv_px", "baseline_m"};
    char reason[64];

    begin_drive();
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) {
        (void)snprintf(reason, sizeof reason, "%s: is missing", keys[i]);
        assert_rig_fault(rig_with(keys[i], ""), reason);
    }
    assert_rig_fault("", "width: is missing");
}

static void test_values_that_are_no_numbers(void) {
    static const char *const keys[] = {"width",   "height",         "focal_px", "cu_px",
                                       "cv_px",   "baseline_m",     "invalid",  "disparity_offset_px",
                                       "rate_hz", "disparity_scale"};
    static const char *const values[] = {"wide", "640x", "6 40", "0x280", "\"640\"", "1,5", "nan", ".inf", "--5", "1e"};
    char line[64], reason[64];

    begin_drive();
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
        for (size_t j = 0; j < sizeof values / sizeof *values; j++) {
            (void)snprintf(line, sizeof line, "%s: %s", keys[i], values[j]);
            (void)snprintf(reason, sizeof reason, "%s: '%s' is not a number", keys[i], values[j]);
            assert_rig_fault(rig_with(keys[i], line), reason);
        }
}

static void test_values_out_of_range(void) {
    static const char *const cases[][3] = {
        {"width", "width: 63", "width: 63 is outside 64...2048"},
        {"width", "width: 2049", "width: 2049 is outside 64...2048"},
        {"width", "width: -640", "width: -640 is outside 64...2048"},
        {"width", "width: 99999999999999999999", "is outside 64...2048"},
        {"width", "width: 320.5", "width: 320.5 is not a whole number"},
        {"height", "height: 63", "height: 63 is outside 64...1536"},
        {"height", "height: 1537", "height: 1537 is outside 64...1536"},
        {"focal_px", "focal_px: 49.9", "focal_px: 49.9 is outside 50...4000"},
        {"focal_px", "focal_px: 4.0001e3", "focal_px: 4.0001e3 is outside 50...4000"},
        {"cu_px", "cu_px: -0.1", "cu_px: -0.1 is outside 0...2047"},
        {"cu_px", "cu_px: 319.5", "cu_px: 319.5 is outside 0...319"},
        {"cv_px", "cv_px: 240", "cv_px: 240 is outside 0...239"},
        {"baseline_m", "baseline_m: 0", "baseline_m: 0 is outside 0.02...2"},
        {"baseline_m", "baseline_m: 2.1", "baseline_m: 2.1 is outside 0.02...2"},
        {"disparity_scale", "disparity_scale: 0", "disparity_scale: 0 is outside 0.000001...1000000"},
        {"disparity_scale", "disparity_scale: -256", "disparity_scale: -256 is outside"},
        {"invalid", "invalid: -1", "invalid: -1 is outside 0...65535"},
        {"invalid", "invalid: 65536", "invalid: 65536 is outside 0...65535"},
        {"disparity_offset_px", "disparity_offset_px: 16.1", "disparity_offset_px: 16.1 is outside -16...16"},
        {"rate_hz", "rate_hz: 0", "rate_hz: 0 is outside 0.001...1000"},
    };

    begin_drive();
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        assert_rig_fault(rig_with(cases[i][0], cases[i][1]), cases[i][2]);
}

static void test_malformed_lines(void) {
    static char long_file[70000];

    begin_drive();
    assert_rig_fault(PLANAR_RIG "just words\n", "line 9 is not 'key: value'");
    assert_rig_fault(PLANAR_RIG "width: 320\n", "width: is given twice");
    assert_rig_fault(rig_with("width", "width:"), "width: has no value");
    assert_rig_fault(rig_with("width", "width:   # none"), "width: has no value");
    scratch_write("drive/rig.yml", PLANAR_RIG "\0", sizeof PLANAR_RIG);
    assert_fault("drive/rig.yml: ", "is not a text file", 0);
    memset(long_file, '#', sizeof long_file);
    scratch_write("drive/rig.yml", long_file, sizeof long_file);
    assert_fault("drive/rig.yml: ", "is larger than", 0);
}

static void test_no_disparity_folder(void) {
    scratch_make_folder("drive");
    scratch_write_text("drive/rig.yml", PLANAR_RIG);
    assert_fault("drive/disparity: ", "cannot be read: No such file", 0);
    scratch_write_text("drive/disparity", "a file");
    assert_fault("drive/disparity: ", "cannot be read: Not a directory", 0);
}

static void test_no_frames(void) {
    planar_recording_begin("drive", PLANAR_RIG);
    assert_fault("drive/disparity: ", "has no frames", 0);
    scratch_write_text("drive/disparity/000000.png", "not for us");
    scratch_write_text("drive/disparity/.pgm", "nor this");
    assert_fault("drive/disparity: ", "has no frames", 0);
}

/* The bad frame comes second: the line of the first one must stand. */
static void assert_frame_fault(const char *header, unsigned bytes, const char *reason) {
    planar_recording_add_raw("drive", "000001.pgm", header, 0, bytes);
    assert_fault("drive/disparity/000001.pgm: ", reason, 2);
}

static void test_wrong_magic(void) {
    begin_drive();
    assert_frame_fault("P2\n320 240\n65535\n", FRAME_BYTES, "the magic is not P5");
    assert_frame_fault("P6\n320 240\n65535\n", FRAME_BYTES, "the magic is not P5");
    assert_frame_fault("P55\n320 240\n65535\n", FRAME_BYTES, "the magic is not P5");
    assert_frame_fault("\x89PNG\r\n", 1000, "the magic is not P5");
    assert_frame_fault("P", 0, "the magic is not P5");
    assert_frame_fault("", 0, "is empty");
}

static void test_malformed_headers(void) {
    static const char *const headers[] = {
        "P5\n",           "P5\n320",      "P5\n320 ",           "P5\n320 240\n", "P5\n320 240\n65535", "P5\nwide 240\n",
        "P5\n-320 240\n", "P5\n320x240 ", "P5\n320 240 65535x", "P5 # no end",   "P5\n320.0 240\n"};

    begin_drive();
    for (size_t i = 0; i < sizeof headers / sizeof *headers; i++)
        assert_frame_fault(headers[i], 0, "the PGM header is malformed");
}

static void test_wrong_maxval(void) {
    begin_drive();
    assert_frame_fault("P5\n320 240\n255\n", FRAME_BYTES / 2, "maxval is 255, not 65535");
    assert_frame_fault("P5\n320 240\n65536\n", FRAME_BYTES, "maxval is 65536, not 65535");
    assert_frame_fault("P5\n320 240\n99999999999999999999\n", FRAME_BYTES, "not 65535");
}

static void test_frame_of_another_size(void) {
    begin_drive();
    assert_frame_fault("P5\n240 320\n65535\n", FRAME_BYTES, "the frame is 240 x 320, the rig 320 x 240");
    assert_frame_fault("P5\n0 0\n65535\n", 0, "the frame is 0 x 0, the rig 320 x 240");
    assert_frame_fault("P5\n4294967616 240\n65535\n", FRAME_BYTES, "the rig 320 x 240");
}

static void test_truncated_frames(void) {
    begin_drive();
    assert_frame_fault(HEADER, 0, "is truncated: 0 of 153600 bytes");
    assert_frame_fault(HEADER, 1, "is truncated: 1 of 153600 bytes");
    assert_frame_fault(HEADER, FRAME_BYTES - 1, "is truncated: 153599 of 153600 bytes");
}

static void test_trailing_bytes(void) {
    begin_drive();
    assert_frame_fault(HEADER, FRAME_BYTES + 1, "is longer than its header says");
    assert_frame_fault(HEADER, 2 * FRAME_BYTES, "is longer than its header says");
}

static void test_unreadable_frames(void) {
    begin_drive();
    scratch_make_folder("drive/disparity/000001.pgm");
    assert_fault("drive/disparity/000001.pgm: ", "cannot be read: Is a directory", 2);
    scratch_remove("drive/disparity/000001.pgm");
    TEST_ASSERT_EQUAL_INT(0, symlink("nowhere", scratch_path("drive/disparity/000001.pgm")));
    assert_fault("drive/disparity/000001.pgm: ", "cannot be read: No such file", 2);
}

static void test_printed_lines_stay_valid(void) {
    program_run_t whole, broken;

    begin_drive();
    planar_recording_add("drive", "000001.pgm", ROAD, PLANAR_Q8);
    whole = program_run(scratch_path("drive"), NULL);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, whole.status, whole.command);
    planar_recording_add_raw("drive", "000002.pgm", HEADER, 0, 7);
    planar_recording_add("drive", "000003.pgm", ROAD, PLANAR_Q8);
    broken = program_run(scratch_path("drive"), NULL);
    TEST_ASSERT_EQUAL_INT_MESSAGE(3, broken.status, broken.command);
    TEST_ASSERT_EQUAL_STRING_MESSAGE(whole.output, broken.output, broken.command);
    program_forget(&whole);
    program_forget(&broken);
}

static void test_a_path_that_is_too_long(void) {
    static char path[5000];
    program_run_t run;

    memset(path, 'a', sizeof path - 1);
    run = program_run(path, NULL);
    TEST_ASSERT_EQUAL_INT(3, run.status);
    TEST_ASSERT_NOT_NULL(strstr(run.errors, "the path is too long"));
    program_forget(&run);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_no_recording_at_all);
    RUN_TEST(test_no_rig);
    RUN_TEST(test_a_folder_instead_of_a_rig);
    RUN_TEST(test_missing_keys);
    RUN_TEST(test_values_that_are_no_numbers);
    RUN_TEST(test_values_out_of_range);
    RUN_TEST(test_malformed_lines);
    RUN_TEST(test_no_disparity_folder);
    RUN_TEST(test_no_frames);
    RUN_TEST(test_wrong_magic);
    RUN_TEST(test_malformed_headers);
    RUN_TEST(test_wrong_maxval);
    RUN_TEST(test_frame_of_another_size);
    RUN_TEST(test_truncated_frames);
    RUN_TEST(test_trailing_bytes);
    RUN_TEST(test_unreadable_frames);
    RUN_TEST(test_printed_lines_stay_valid);
    RUN_TEST(test_a_path_that_is_too_long);
    return UNITY_END();
}
