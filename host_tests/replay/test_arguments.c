/* Command line of roadpose-replay: --help, bad arguments (exit 2, one line with a hint), and what the good ones reach.
 */
#include <string.h>

#include "planar_recording.h"
#include "program.h"
#include "scratch.h"
#include "unity.h"

#define ROAD ((planar_pose_t){4.0, 0.0, 1.5})

void setUp(void) {
    scratch_make();
}

void tearDown(void) {
    scratch_end(Unity.CurrentTestFailed);
}

static void assert_one_line(const program_run_t *run) {
    const char *end = strchr(run->errors, '\n');

    TEST_ASSERT_NOT_NULL_MESSAGE(end, run->command);
    TEST_ASSERT_EQUAL_STRING_MESSAGE("\n", end, run->command);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, strncmp(run->errors, "roadpose-replay: ", 17), run->command);
}

static void assert_refused(program_run_t run, const char *reason) {
    TEST_ASSERT_EQUAL_INT_MESSAGE(2, run.status, run.command);
    TEST_ASSERT_EQUAL_STRING_MESSAGE("", run.output, run.command);
    assert_one_line(&run);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(run.errors, reason), run.errors);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(run.errors, "--help"), run.errors);
    program_forget(&run);
}

static void test_help(void) {
    static const char *const options[] = {"--method", "--no-refine", "--corridor", "--range",
                                          "--points", "--seed",      "--help",     "RECORDING"};
    program_run_t run = program_run("--help", NULL);

    TEST_ASSERT_EQUAL_INT_MESSAGE(0, run.status, run.command);
    TEST_ASSERT_EQUAL_STRING_MESSAGE("", run.errors, run.command);
    for (size_t i = 0; i < sizeof options / sizeof *options; i++)
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(run.output, options[i]), options[i]);
    program_forget(&run);
}

static void test_help_comes_before_later_faults(void) {
    program_run_t run = program_run("--seed", "7", "--help", "--nonsense", NULL);

    TEST_ASSERT_EQUAL_INT_MESSAGE(0, run.status, run.command);
    program_forget(&run);
}

static void test_no_recording(void) {
    assert_refused(program_run(NULL), "no recording given");
    assert_refused(program_run("--no-refine", NULL), "no recording given");
    assert_refused(program_run("", NULL), "no name");
}

static void test_two_recordings(void) {
    assert_refused(program_run("one", "two", NULL), "'two'");
    assert_refused(program_run("one", "--", "--two", NULL), "'--two'");
}

static void test_unknown_options(void) {
    assert_refused(program_run("--frobnicate", "one", NULL), "unknown option '--frobnicate'");
    assert_refused(program_run("-m", "1", "one", NULL), "unknown option '-m'");
    assert_refused(program_run("--methods", "1", "one", NULL), "unknown option '--methods'");
}

static void test_a_control_character_does_not_break_the_line(void) {
    assert_refused(program_run("--two\nlines\033[31m", "one", NULL), "unknown option '--two?lines?[31m'");
}

static void test_missing_numbers(void) {
    static const char *const options[] = {"--method", "--corridor", "--range", "--points", "--seed"};

    for (size_t i = 0; i < sizeof options / sizeof *options; i++)
        assert_refused(program_run("one", options[i], NULL), "needs a number");
}

static void test_no_numbers(void) {
    static const char *const texts[] = {"",    "x",   "1x", "0x1", "1,5", "--",  " 1", "1 ",
                                        "nan", "inf", "+",  ".",   "1e",  "1e+", "2-1"};

    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        assert_refused(program_run("--method", texts[i], "one", NULL), "is not a number");
        assert_refused(program_run("--corridor", texts[i], "one", NULL), "is not a number");
    }
}

static void test_pictures_need_another_build(void) {
    assert_refused(program_run("--pictures", "folder", "one", NULL), "OpenCV");
    assert_refused(program_run("one", "--pictures", NULL), "needs a name");
}

static void test_broken_numbers(void) {
    assert_refused(program_run("--method", "1.5", "one", NULL), "is not a whole number");
    assert_refused(program_run("--points", "0.5", "one", NULL), "is not a whole number");
    assert_refused(program_run("--seed", "1e-1", "one", NULL), "is not a whole number");
}

static void test_numbers_out_of_range(void) {
    static const char *const cases[][3] = {
        {"--method", "0", "1...2"},
        {"--method", "3", "1...2"},
        {"--method", "-1", "1...2"},
        {"--corridor", "-2", "0.5...100"},
        {"--corridor", "0.4994", "0.5...100"},
        {"--corridor", "100.001", "0.5...100"},
        {"--corridor", "0.0001", "0.5...100"},
        {"--corridor", "1e300", "0.5...100"},
        {"--range", "4.9", "5...500"},
        {"--range", "501", "5...500"},
        {"--points", "0", "1...100"},
        {"--points", "101", "1...100"},
        {"--seed", "-1", "0...4294967295"},
        {"--seed", "4294967296", "0...4294967295"},
        {"--seed", "99999999999999999999999999", "0...4294967295"},
    };

    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        assert_refused(program_run(cases[i][0], cases[i][1], "one", NULL), cases[i][2]);
}

static void test_every_good_option_plays(void) {
    static const char *const cases[][2] = {
        {"--method", "1"},     {"--method", "2"},     {"--method", "+2.0"},
        {"--corridor", "0"},   {"--corridor", "0.5"}, {"--range", "0"},
        {"--range", "5"},      {"--range", "2.5e1"},  {"--points", "1"},
        {"--points", "100"},   {"--seed", "0"},       {"--seed", "4294967295"},
        {"--corridor", "100"}, {"--range", "500"},    {"--no-refine", "--no-refine"},
    };

    planar_recording_begin("road", PLANAR_RIG);
    planar_recording_add("road", "000000.pgm", ROAD, PLANAR_Q8);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        program_run_t run = program_run(cases[i][0], cases[i][1], scratch_path("road"), NULL);

        TEST_ASSERT_EQUAL_INT_MESSAGE(0, run.status, run.command);
        TEST_ASSERT_EQUAL_STRING_MESSAGE("", run.errors, run.command);
        program_forget(&run);
    }
}

static void test_options_may_follow_the_recording_and_the_last_one_wins(void) {
    program_run_t first, second;

    planar_recording_begin("road", PLANAR_RIG);
    planar_recording_add("road", "000000.pgm", ROAD, PLANAR_Q8);
    first = program_run("--method", "1", "--no-refine", scratch_path("road"), NULL);
    second = program_run("--method", "2", scratch_path("road"), "--no-refine", "--method", "1", NULL);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, second.status, second.command);
    TEST_ASSERT_EQUAL_STRING_MESSAGE(first.output, second.output, second.command);
    program_forget(&first);
    program_forget(&second);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_help);
    RUN_TEST(test_help_comes_before_later_faults);
    RUN_TEST(test_no_recording);
    RUN_TEST(test_two_recordings);
    RUN_TEST(test_unknown_options);
    RUN_TEST(test_a_control_character_does_not_break_the_line);
    RUN_TEST(test_missing_numbers);
    RUN_TEST(test_no_numbers);
    RUN_TEST(test_pictures_need_another_build);
    RUN_TEST(test_broken_numbers);
    RUN_TEST(test_numbers_out_of_range);
    RUN_TEST(test_every_good_option_plays);
    RUN_TEST(test_options_may_follow_the_recording_and_the_last_one_wins);
    return UNITY_END();
}
