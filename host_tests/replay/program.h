/* Runs roadpose-replay as a user would and keeps what it said. */
#ifndef ROADPOSE_TEST_PROGRAM_H
#define ROADPOSE_TEST_PROGRAM_H

#include <stdbool.h>

typedef struct {
    int status;         /* exit status; 1000 + the signal if one ended it */
    char *output;       /* standard output */
    char *errors;       /* standard error */
    char command[2048]; /* runs it again: the message of every assertion */
} program_run_t;

/* Runs the program with the given arguments, NULL last. Forget the run when done. */
program_run_t program_run(const char *argument, ...);
void program_forget(program_run_t *run);

/* The same with standard output going to a file, and with standard error to a terminal. */
program_run_t program_run_into(const char *output_path, const char *argument, ...);
program_run_t program_run_on_terminal(const char *argument, ...);

#endif
