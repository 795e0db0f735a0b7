#include "rig_file.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "decimal.h"
#include "fault.h"

#define FILE_BYTES 65536
#define MICRO INT64_C(1000000)
#define RESCALED_INVALID 0xFFFFu /* 255.996 px in 1/256 px: given up, so that 0 keeps its meaning before the offset */

typedef enum { WIDTH, HEIGHT, FOCAL, CU, CV, BASELINE, SCALE, INVALID, OFFSET, RATE, FIELD_COUNT } field_t;

/* Limits and defaults are scaled by 10^places. The upper limits of cu_px and cv_px depend on the image. */
static const struct {
    const char *key;
    int places;
    bool is_required;
    int64_t least;
    int64_t most;
    int64_t otherwise;
} fields[FIELD_COUNT] = {
    [WIDTH] = {"width", 0, true, 64, ROADPOSE_MAX_WIDTH, 0},
    [HEIGHT] = {"height", 0, true, 64, ROADPOSE_MAX_HEIGHT, 0},
    [FOCAL] = {"focal_px", 3, true, 50000, 4000000, 0},
    [CU] = {"cu_px", 3, true, 0, INT64_C(1000) * (ROADPOSE_MAX_WIDTH - 1), 0},
    [CV] = {"cv_px", 3, true, 0, INT64_C(1000) * (ROADPOSE_MAX_HEIGHT - 1), 0},
    [BASELINE] = {"baseline_m", 6, true, 20000, 2000000, 0},
    [SCALE] = {"disparity_scale", 6, false, 1, MICRO * 1000000, MICRO * 256},
    [INVALID] = {"invalid", 0, false, 0, 65535, 0},
    [OFFSET] = {"disparity_offset_px", 3, false, -16000, 16000, 0},
    [RATE] = {"rate_hz", 3, false, 1, 1000000, 10000},
};

typedef struct {
    bool is_given[FIELD_COUNT];
    int64_t value[FIELD_COUNT];
} fields_t;

static bool load(char text[FILE_BYTES], const char *path) {
    FILE *file = fopen(path, "rb");
    bool is_failed;
    size_t bytes;
    int reason;

    if (file == NULL)
        return fault(path, "cannot be read: %s", strerror(errno));
    bytes = fread(text, 1, FILE_BYTES, file);
    reason = errno;
    is_failed = ferror(file) != 0;
    (void)fclose(file);
    if (is_failed)
        return fault(path, "cannot be read: %s", strerror(reason));
    if (bytes == FILE_BYTES)
        return fault(path, "is larger than %d bytes", FILE_BYTES - 1);
    if (memchr(text, '\0', bytes) != NULL)
        return fault(path, "is not a text file");
    text[bytes] = '\0';
    return true;
}

static bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}

/* Cuts a comment (at the begin or after a blank, as in YAML) and blanks off the end. */
static void trim_end(char *line) {
    char *end = line;

    for (; *end != '\0'; end++)
        if (*end == '#' && (end == line || is_blank(end[-1])))
            break;
    while (end > line && is_blank(end[-1]))
        end--;
    *end = '\0';
}

static bool check_range(const char *path, field_t field, const char *text, int64_t value, int64_t most) {
    char least_text[DECIMAL_TEXT_BYTES], most_text[DECIMAL_TEXT_BYTES];

    if (value >= fields[field].least && value <= most)
        return true;
    decimal_print_short(least_text, fields[field].least, fields[field].places);
    decimal_print_short(most_text, most, fields[field].places);
    return fault(path, "%s: %.40s is outside %s...%s", fields[field].key, text, least_text, most_text);
}

static bool take_value(fields_t *read, const char *path, field_t field, const char *text) {
    const char *key = fields[field].key;
    decimal_t number;

    if (read->is_given[field])
        return fault(path, "%s: is given twice", key);
    if (*text == '\0')
        return fault(path, "%s: has no value", key);
    if (!decimal_parse(text, fields[field].places, &number))
        return fault(path, "%s: '%.40s' is not a number", key, text);
    if (!check_range(path, field, text, number.scaled, fields[field].most))
        return false;
    if (fields[field].places == 0 && !number.is_exact)
        return fault(path, "%s: %.40s is not a whole number", key, text);
    read->is_given[field] = true;
    read->value[field] = number.scaled;
    return true;
}

static field_t find_field(const char *key) {
    field_t field = WIDTH;

    while (field < FIELD_COUNT && strcmp(key, fields[field].key) != 0)
        field++;
    return field;
}

/* Indented lines belong to nested values of keys that are not ours; so do unknown keys. */
static bool take_line(fields_t *read, const char *path, char *line, unsigned number) {
    char *value;
    field_t field;

    trim_end(line);
    if (is_blank(*line) || *line == '\0' || *line == '%' || strcmp(line, "---") == 0 || strcmp(line, "...") == 0)
        return true;
    value = strchr(line, ':');
    if (value == NULL)
        return fault(path, "line %u is not 'key: value'", number);
    *value++ = '\0';
    trim_end(line);
    while (is_blank(*value))
        value++;
    field = find_field(line);
    return field == FIELD_COUNT || take_value(read, path, field, value);
}

static bool take_lines(fields_t *read, const char *path, char *text) {
    unsigned number = 1;

    while (text != NULL) {
        char *next = strchr(text, '\n');

        if (next != NULL)
            *next++ = '\0';
        if (!take_line(read, path, text, number++))
            return false;
        text = next;
    }
    return true;
}

static bool fill_absent(fields_t *read, const char *path) {
    field_t field;

    for (field = WIDTH; field < FIELD_COUNT; field++) {
        if (read->is_given[field])
            continue;
        if (fields[field].is_required)
            return fault(path, "%s: is missing", fields[field].key);
        read->value[field] = fields[field].otherwise;
    }
    return true;
}

static bool check_inside(const fields_t *read, const char *path, field_t field, field_t side) {
    char text[DECIMAL_TEXT_BYTES];

    decimal_print_short(text, read->value[field], fields[field].places);
    return check_range(path, field, text, read->value[field], 1000 * (read->value[side] - 1));
}

/* Fraction bits of a scale that the format can express, or -1. */
static int fraction_bits(int64_t scale_micro) {
    int bits;

    for (bits = 0; bits <= 15; bits++)
        if (scale_micro == MICRO << bits)
            return bits;
    return -1;
}

static void fill_format(rig_file_t *rig_file, const fields_t *read) {
    roadpose_disparity_format_t *format = &rig_file->format;
    const int bits = fraction_bits(read->value[SCALE]);

    rig_file->scale_micro = read->value[SCALE];
    rig_file->invalid = (uint16_t)read->value[INVALID];
    rig_file->is_rescaled = bits < 0;
    (void)roadpose_format_preset(format, ROADPOSE_FORMAT_U16_Q8);
    format->byte_order = ROADPOSE_BYTES_BIG; /* a PGM's */
    format->fraction_bits = rig_file->is_rescaled ? 8 : (uint8_t)bits;
    format->has_invalid = true;
    format->invalid_first = rig_file->is_rescaled ? RESCALED_INVALID : rig_file->invalid;
    format->invalid_last = format->invalid_first;
    format->offset_millipx = (int32_t)read->value[OFFSET];
}

static void fill_rig(rig_file_t *rig_file, const fields_t *read) {
    rig_file->rig.width_px = (uint16_t)read->value[WIDTH];
    rig_file->rig.height_px = (uint16_t)read->value[HEIGHT];
    rig_file->rig.focal_millipx = (int32_t)read->value[FOCAL];
    rig_file->rig.cu_millipx = (int32_t)read->value[CU];
    rig_file->rig.cv_millipx = (int32_t)read->value[CV];
    rig_file->rig.baseline_um = (int32_t)read->value[BASELINE];
    rig_file->rate_millihz = read->value[RATE];
}

bool rig_file_read(rig_file_t *rig_file, const char *path) {
    static char text[FILE_BYTES];
    fields_t read = {{false}, {0}};

    if (!load(text, path) || !take_lines(&read, path, text) || !fill_absent(&read, path))
        return false;
    if (!check_inside(&read, path, CU, WIDTH) || !check_inside(&read, path, CV, HEIGHT))
        return false;
    fill_rig(rig_file, &read);
    fill_format(rig_file, &read);
    return true;
}

/* 65535 * 256e6 + 1e12 / 2 < 2^44 + 2^39: no overflow. */
uint16_t rig_file_rescale(const rig_file_t *rig_file, uint16_t sample) {
    int64_t scaled;

    if (sample == rig_file->invalid)
        return RESCALED_INVALID;
    scaled = (sample * (256 * MICRO) + rig_file->scale_micro / 2) / rig_file->scale_micro;
    return (uint16_t)(scaled < RESCALED_INVALID ? scaled : RESCALED_INVALID);
}
