/* What goes to standard error: one line for a fault, and the progress when somebody watches. */
#ifndef REPLAY_FAULT_H
#define REPLAY_FAULT_H

#include <stdbool.h>
#include <stddef.h>

#define EXIT_BAD_ARGUMENTS 2
#define EXIT_BAD_RECORDING 3

#define PATH_BYTES 4096

#if defined(__GNUC__)
#define PRINTF_LIKE(text, first) __attribute__((format(printf, text, first)))
#else
#define PRINTF_LIKE(text, first)
#endif

/* Prints "roadpose-replay: WHERE: MESSAGE" as exactly one line: control characters are replaced. where may be NULL.
 * Returns false, so that a failing function can return it. */
bool fault(const char *where, const char *format, ...) PRINTF_LIKE(2, 3);

/* Joins a folder and a name into path. Reports a fault and returns false if it does not fit. */
bool join_path(char path[PATH_BYTES], const char *folder, const char *name);

/* Shows how far the recording is, in place, if standard error is a terminal. */
void progress_show(size_t done, size_t total);

/* Takes the progress off the terminal's line. */
void progress_clear(void);

#endif
