#include "program.h"

#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include "scratch.h"
#include "unity.h"

#define ARGUMENTS_MAX 16

typedef struct {
    char *list[ARGUMENTS_MAX + 2];
} arguments_t;

static arguments_t collect(const char *first, va_list rest) {
    static char program[] = REPLAY_PROGRAM;
    arguments_t arguments = {{program, NULL}};
    int count = 1;

    for (const char *argument = first; argument != NULL && count <= ARGUMENTS_MAX;
         argument = va_arg(rest, const char *))
        arguments.list[count++] = (char *)(size_t)argument; /* execv() takes them without const, but does not write */
    return arguments;
}

static void describe(program_run_t *run, const arguments_t *arguments) {
    size_t length = (size_t)snprintf(run->command, sizeof run->command, "again:");

    for (int i = 0; arguments->list[i] != NULL && length < sizeof run->command; i++)
        length += (size_t)snprintf(run->command + length, sizeof run->command - length, " '%s'", arguments->list[i]);
}

static char *read_all(int file) {
    size_t used = 0, size = 65536;
    char *text = malloc(size);
    ssize_t got = 1;

    TEST_ASSERT_NOT_NULL(text);
    while (got > 0) {
        if (size - used < 2) {
            size *= 2;
            text = realloc(text, size);
            TEST_ASSERT_NOT_NULL(text);
        }
        got = read(file, text + used, size - used - 1);
        used += got > 0 ? (size_t)got : 0; /* a terminal whose other end has gone reads as an error: the end */
    }
    text[used] = '\0';
    return text;
}

static char *read_file(const char *path) {
    const int file = open(path, O_RDONLY);
    char *text;

    TEST_ASSERT_TRUE_MESSAGE(file >= 0, path);
    text = read_all(file);
    (void)close(file);
    return text;
}

static void run_child(char *const *arguments, int output, int errors) {
    (void)dup2(output, STDOUT_FILENO);
    (void)dup2(errors, STDERR_FILENO);
    (void)execv(arguments[0], arguments);
    _exit(127);
}

static int wait_for(pid_t child) {
    int status = 0;

    TEST_ASSERT_EQUAL_INT(child, waitpid(child, &status, 0));
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
}

/* terminal: the controlling side of the terminal that is errors, or -1 when that is a file. */
static program_run_t run_with(const arguments_t *arguments, const char *output_path, int errors, int terminal) {
    const int output = open(output_path, O_WRONLY | O_CREAT | O_TRUNC, 0666);
    program_run_t run = {0, NULL, NULL, ""};
    pid_t child;

    describe(&run, arguments);
    TEST_ASSERT_TRUE_MESSAGE(output >= 0 && errors >= 0, run.command);
    (void)fflush(stdout);
    child = fork();
    if (child == 0)
        run_child(arguments->list, output, errors);
    (void)close(output);
    (void)close(errors);
    if (terminal >= 0)
        run.errors = read_all(terminal);
    run.status = wait_for(child);
    return run;
}

static program_run_t run_to_files(const arguments_t *arguments, const char *output_path) {
    const int errors = open(scratch_path("stderr"), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    program_run_t run = run_with(arguments, output_path, errors, -1);

    run.errors = read_file(scratch_path("stderr"));
    return run;
}

program_run_t program_run(const char *argument, ...) {
    program_run_t run;
    va_list rest;

    va_start(rest, argument);
    const arguments_t arguments = collect(argument, rest);
    va_end(rest);
    run = run_to_files(&arguments, scratch_path("stdout"));
    run.output = read_file(scratch_path("stdout"));
    return run;
}

program_run_t program_run_into(const char *output_path, const char *argument, ...) {
    va_list rest;

    va_start(rest, argument);
    const arguments_t arguments = collect(argument, rest);
    va_end(rest);
    return run_to_files(&arguments, output_path);
}

program_run_t program_run_on_terminal(const char *argument, ...) {
    const int terminal = posix_openpt(O_RDWR | O_NOCTTY);
    program_run_t run;
    va_list rest;

    TEST_ASSERT_TRUE_MESSAGE(terminal >= 0 && grantpt(terminal) == 0 && unlockpt(terminal) == 0, "no terminal");
    va_start(rest, argument);
    const arguments_t arguments = collect(argument, rest);
    va_end(rest);
    run = run_with(&arguments, scratch_path("stdout"), open(ptsname(terminal), O_RDWR | O_NOCTTY), terminal);
    run.output = read_file(scratch_path("stdout"));
    (void)close(terminal);
    return run;
}

void program_forget(program_run_t *run) {
    free(run->output);
    free(run->errors);
    run->output = NULL;
    run->errors = NULL;
}
