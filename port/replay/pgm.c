#include "pgm.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "fault.h"

#define NO_NUMBER (-1)
#define NUMBER_LIMIT 1000000L /* larger numbers saturate: no image has such a side */

typedef struct {
    long width;
    long height;
    long maxval;
} header_t;

static bool is_blank(int c) {
    return c == ' ' || (c >= '\t' && c <= '\r');
}

/* First character after blanks and comments. */
static int skip_blanks(FILE *file) {
    int c = getc(file);

    while (is_blank(c) || c == '#') {
        if (c == '#')
            while (c != '\n' && c != EOF)
                c = getc(file);
        else
            c = getc(file);
    }
    return c;
}

/* Takes the one blank that must follow a number as well. */
static long read_number(FILE *file) {
    int c = skip_blanks(file);
    long number = c >= '0' && c <= '9' ? 0 : NO_NUMBER;

    for (; c >= '0' && c <= '9'; c = getc(file))
        number = number < NUMBER_LIMIT ? number * 10 + (c - '0') : NUMBER_LIMIT;
    return is_blank(c) ? number : NO_NUMBER;
}

static bool read_header(header_t *header, FILE *file, const char *path) {
    const int p = getc(file);
    const int five = getc(file);
    const int blank = getc(file);

    if (p != 'P' || five != '5' || !(is_blank(blank) || blank == '#'))
        return fault(path, "is not a binary PGM: the magic is not P5");
    if (blank == '#')
        (void)ungetc(blank, file);
    header->width = read_number(file);
    header->height = header->width == NO_NUMBER ? NO_NUMBER : read_number(file);
    header->maxval = header->height == NO_NUMBER ? NO_NUMBER : read_number(file);
    if (header->maxval == NO_NUMBER)
        return fault(path, "the PGM header is malformed: no whole number where width, height or maxval should be");
    return true;
}

static bool check_header(const header_t *header, long maxval, uint16_t width_px, uint16_t height_px, const char *path) {
    if (header->maxval != maxval)
        return fault(path, "maxval is %ld, not %ld", header->maxval, maxval);
    if (header->width != width_px || header->height != height_px)
        return fault(path, "the frame is %ld x %ld, the rig %u x %u", header->width, header->height, (unsigned)width_px,
                     (unsigned)height_px);
    return true;
}

static bool read_samples(uint8_t *samples, size_t bytes, FILE *file, const char *path) {
    const size_t got = fread(samples, 1, bytes, file);

    if (got != bytes && !ferror(file))
        return fault(path, "is truncated: %zu of %zu bytes of samples", got, bytes);
    if (got == bytes && getc(file) != EOF)
        return fault(path, "is longer than its header says");
    return true;
}

static bool read_image(uint8_t *samples, long maxval, uint16_t width_px, uint16_t height_px, FILE *file,
                       const char *path) {
    const size_t bytes_per_sample = maxval > 255 ? 2u : 1u;
    header_t header;
    const int first = getc(file);

    if (first == EOF && ferror(file)) /* a folder, for example: opens, but does not read */
        return fault(path, "cannot be read: %s", strerror(errno));
    if (first == EOF)
        return fault(path, "is empty");
    (void)ungetc(first, file);
    if (!read_header(&header, file, path) || !check_header(&header, maxval, width_px, height_px, path))
        return false;
    if (!read_samples(samples, (size_t)width_px * height_px * bytes_per_sample, file, path))
        return false;
    return !ferror(file) || fault(path, "cannot be read: %s", strerror(errno));
}

static bool read_file(uint8_t *samples, long maxval, uint16_t width_px, uint16_t height_px, const char *path) {
    FILE *file = fopen(path, "rb");
    bool is_read;

    if (file == NULL)
        return fault(path, "cannot be read: %s", strerror(errno));
    is_read = read_image(samples, maxval, width_px, height_px, file, path);
    (void)fclose(file);
    return is_read;
}

bool pgm_read(uint8_t *samples, uint16_t width_px, uint16_t height_px, const char *path) {
    return read_file(samples, 65535, width_px, height_px, path);
}

bool pgm_read_grey(uint8_t *samples, uint16_t width_px, uint16_t height_px, const char *path) {
    return read_file(samples, 255, width_px, height_px, path);
}
