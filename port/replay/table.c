#include "table.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "decimal.h"

#define LINE_BYTES 1024
#define ROWS_MAX 1000000u

typedef struct {
    table_t *table;
    const table_column_t *columns;
    const char *path;
    size_t capacity; /* rows */
    unsigned line;
} reader_t;

/* One line without its end. False at the end of the file and after a fault, which *is_sound then tells apart. */
static bool next_line(reader_t *reader, FILE *file, char line[LINE_BYTES], bool *is_sound) {
    size_t length;

    errno = 0;
    *is_sound = true;
    if (fgets(line, LINE_BYTES, file) == NULL) {
        *is_sound = !ferror(file) || fault(reader->path, "cannot be read: %s", strerror(errno));
        return false;
    }
    reader->line++;
    length = strlen(line);
    if ((length == 0 || line[length - 1] != '\n') && !feof(file)) {
        *is_sound = fault(reader->path, "line %u is longer than %d bytes, or no text", reader->line, LINE_BYTES - 2);
        return false;
    }
    while (length > 0 && (line[length - 1] == '\n' || line[length - 1] == '\r'))
        line[--length] = '\0';
    return true;
}

/* Cuts off and returns the next field; *rest is NULL after the last one. */
static char *next_field(char **rest) {
    char *field = *rest;
    char *end = field;

    if (field == NULL)
        return NULL;
    end = strchr(field, ',');
    *rest = end == NULL ? NULL : end + 1;
    if (end != NULL)
        *end = '\0';
    field += strspn(field, " \t");
    for (end = field + strlen(field); end > field && (end[-1] == ' ' || end[-1] == '\t'); end--)
        end[-1] = '\0';
    return field;
}

static bool check_header(const reader_t *reader, char *line) {
    size_t column;

    for (column = 0; column < reader->table->columns; column++) {
        const char *field = next_field(&line);

        if (field == NULL || strcmp(field, reader->columns[column].name) != 0)
            return fault(reader->path, "line %u: column %zu is '%.40s', not %s", reader->line, column + 1,
                         field == NULL ? "" : field, reader->columns[column].name);
    }
    return true;
}

static bool take_field(const reader_t *reader, const table_column_t *column, const char *field, int64_t *value) {
    decimal_t number;

    if (field == NULL)
        return fault(reader->path, "line %u: has no %s", reader->line, column->name);
    if (*field == '\0' && column->may_be_empty) {
        *value = TABLE_EMPTY;
        return true;
    }
    if (!decimal_parse(field, column->places, &number))
        return fault(reader->path, "line %u: %s: '%.40s' is not a number", reader->line, column->name, field);
    *value = number.scaled;
    return true;
}

static bool grow(reader_t *reader) {
    const size_t capacity = reader->capacity == 0 ? 256 : 2 * reader->capacity;
    int64_t *value;

    if (reader->table->rows < reader->capacity)
        return true;
    if (reader->table->rows >= ROWS_MAX)
        return fault(reader->path, "has more than %u lines", ROWS_MAX);
    value = realloc(reader->table->value, capacity * reader->table->columns * sizeof *value);
    if (value == NULL)
        return fault(reader->path, "is larger than memory");
    reader->table->value = value;
    reader->capacity = capacity;
    return true;
}

static bool take_row(reader_t *reader, char *line) {
    table_t *table = reader->table;
    size_t column;

    if (!grow(reader))
        return false;
    for (column = 0; column < table->columns; column++)
        if (!take_field(reader, &reader->columns[column], next_field(&line),
                        &table->value[table->rows * table->columns + column]))
            return false;
    table->rows++;
    return true;
}

static bool read_rows(reader_t *reader, FILE *file) {
    char line[LINE_BYTES];
    bool is_sound;

    if (!next_line(reader, file, line, &is_sound))
        return is_sound && fault(reader->path, "is empty");
    if (!check_header(reader, line))
        return false;
    while (next_line(reader, file, line, &is_sound))
        if (line[0] != '\0' && !take_row(reader, line))
            return false;
    return is_sound;
}

bool table_read(table_t *table, const table_column_t *columns, size_t count, const char *path) {
    reader_t reader = {table, columns, path, 0, 0};
    FILE *file = fopen(path, "rb");
    bool is_read;

    *table = (table_t){0, count, NULL};
    if (file == NULL)
        return fault(path, "cannot be read: %s", strerror(errno));
    is_read = read_rows(&reader, file);
    (void)fclose(file);
    if (!is_read)
        table_free(table);
    return is_read;
}

void table_free(table_t *table) {
    free(table->value);
    table->value = NULL;
    table->rows = 0;
}
