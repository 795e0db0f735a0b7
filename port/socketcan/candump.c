#include "candump.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

bool roadpose_candump_open(roadpose_candump_t *log, const char *path, const char *interface) {
    memset(log, 0, sizeof *log);
    (void)strncat(log->name, interface, sizeof log->name - 1u);
    log->owns_file = strcmp(path, "-") != 0;
    log->file = log->owns_file ? fopen(path, "w") : stdout;
    return log->file != NULL;
}

void roadpose_candump_write(roadpose_candump_t *log, uint64_t time_us, uint32_t id, const uint8_t data[8]) {
    const bool extended = (id & ROADPOSE_CAN_EXTENDED) != 0u;
    if (log->file == NULL)
        return;
    bool written = fprintf(log->file, "(%010" PRIu64 ".%06" PRIu64 ") %s %0*" PRIX32 "#", time_us / 1000000u,
                           time_us % 1000000u, log->name, extended ? 8 : 3, id & ROADPOSE_CAN_EXTENDED_MASK) > 0;
    for (unsigned i = 0; i < ROADPOSE_CAN_BYTES; i++)
        written = fprintf(log->file, "%02X", data[i]) > 0 && written;
    written = fputc('\n', log->file) != EOF && written;
    written = fflush(log->file) == 0 && written;
    if (!written && log->error == 0)
        log->error = errno;
}

bool roadpose_candump_close(roadpose_candump_t *log) {
    if (log->file != NULL && log->owns_file && fclose(log->file) != 0 && log->error == 0)
        log->error = errno;
    log->file = NULL;
    return log->error == 0;
}

static bool parse_data(const char *hex, roadpose_candump_frame_t *frame) {
    const size_t digits = strspn(hex, "0123456789ABCDEFabcdef");
    if (digits % 2u != 0u || digits > 2u * ROADPOSE_CAN_BYTES)
        return false;
    const size_t bytes = digits / 2u;
    frame->length = (uint8_t)bytes;
    for (size_t i = 0; i < bytes; i++) {
        const char pair[3] = {hex[2u * i], hex[2u * i + 1u], '\0'};
        frame->data[i] = (uint8_t)strtoul(pair, NULL, 16);
    }
    return hex[digits] == '\0' || strchr(" \r\n", hex[digits]) != NULL; /* newer tools add a blank and R or T */
}

/* An identifier of eight digits has 29 bits, one of three has 11. Error frames have a flag above both. */
static bool parse_id(const char *text, roadpose_candump_frame_t *frame) {
    const size_t digits = strspn(text, "0123456789ABCDEFabcdef");
    const unsigned long id = strtoul(text, NULL, 16);
    if (text[digits] != '#' ||
        !((digits == 3u && id <= ROADPOSE_CAN_STANDARD_MASK) || (digits == 8u && id <= ROADPOSE_CAN_EXTENDED_MASK)))
        return false;
    frame->id = (uint32_t)id | (digits == 8u ? ROADPOSE_CAN_EXTENDED : 0u);
    return parse_data(text + digits + 1u, frame);
}

bool roadpose_candump_parse(const char *line, roadpose_candump_frame_t *frame) {
    uint64_t seconds;
    uint32_t microseconds;
    int start = 0;
    memset(frame, 0, sizeof *frame);
    if (sscanf(line, "(%" SCNu64 ".%6" SCNu32 ") %*31s %n", &seconds, &microseconds, &start) != 2 || start == 0)
        return false;
    frame->time_us = seconds * 1000000u + microseconds;
    return parse_id(line + start, frame);
}
