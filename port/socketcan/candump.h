/* The log format of can-utils, `candump -L`: one line a frame,
 *     (1436509052.249713) vcan0 123#1122334455667788
 * which canplayer plays, and cantools, Wireshark and SavvyCAN read. Writing, and reading one line. */
#ifndef ROADPOSE_CANDUMP_H
#define ROADPOSE_CANDUMP_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "roadpose/can_port.h"

#define ROADPOSE_CANDUMP_NAME_BYTES 16u

typedef struct {
    uint64_t time_us;
    uint32_t id;    /* with ROADPOSE_CAN_EXTENDED where it has 29 bits */
    uint8_t length; /* 0...8 */
    uint8_t data[ROADPOSE_CAN_BYTES];
} roadpose_candump_frame_t;

typedef struct {
    FILE *file; /* NULL: closed */
    bool owns_file;
    char name[ROADPOSE_CANDUMP_NAME_BYTES]; /* of the interface, as the log calls it */
    int error; /* errno of the first line that could not be written; 0: all are */
} roadpose_candump_t;

/* Opens a log; path "-" is standard output. interface: its name in the log, at most 15 characters, longer is cut.
 * Returns false when the file cannot be created; errno tells why. Each line is written at once, so that a listener at
 * the end of a pipe sees it. */
bool roadpose_candump_open(roadpose_candump_t *log, const char *path, const char *interface);

/* Writes one line. Does nothing on a closed log. */
void roadpose_candump_write(roadpose_candump_t *log, uint64_t time_us, uint32_t id, const uint8_t data[8]);

/* Closes. Returns false when any line, or the closing, failed: the disk was full; error says why. May be called twice. */
bool roadpose_candump_close(roadpose_candump_t *log);

/* Reads one line. Returns false on anything else than a classic CAN data frame. */
bool roadpose_candump_parse(const char *line, roadpose_candump_frame_t *frame);

#endif
