#include "fault.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#ifndef PROGRAM /* the firmware, which shares this file, is called otherwise */
#define PROGRAM "roadpose-replay"
#endif
#define MESSAGE_BYTES 512

static bool is_progress_shown;

static void put_printable(const char *text) {
    for (; *text != '\0'; text++)
        (void)fputc((unsigned char)*text < 0x20 || *text == 0x7f ? '?' : *text, stderr);
}

bool fault(const char *where, const char *format, ...) {
    char message[MESSAGE_BYTES];
    va_list arguments;

    va_start(arguments, format);
    (void)vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    (void)fflush(stdout); /* lines already printed stay valid, and come first where both go to one place */
    progress_clear();
    (void)fputs(PROGRAM ": ", stderr);
    if (where != NULL) {
        put_printable(where);
        (void)fputs(": ", stderr);
    }
    put_printable(message);
    (void)fputc('\n', stderr);
    return false;
}

bool join_path(char path[PATH_BYTES], const char *folder, const char *name) {
    const int length = snprintf(path, PATH_BYTES, "%s/%s", folder, name);

    if (length < 0 || length >= PATH_BYTES)
        return fault(folder, "the path is too long");
    return true;
}

void progress_show(size_t done, size_t total) {
    if (isatty(STDERR_FILENO) != 1)
        return;
    (void)fprintf(stderr, "\r%zu of %zu frames", done, total);
    (void)fflush(stderr);
    is_progress_shown = true;
}

void progress_clear(void) {
    if (is_progress_shown)
        (void)fputs("\r\033[K", stderr);
    is_progress_shown = false;
}
