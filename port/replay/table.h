/* CSV files of a recording: a header that names the columns, then lines of numbers. */
#ifndef REPLAY_TABLE_H
#define REPLAY_TABLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "fault.h"

#define TABLE_COLUMNS_MAX 8

typedef struct {
    const char *name;
    int places;       /* a number is kept times 10^places */
    bool may_be_empty;
} table_column_t;

typedef struct {
    size_t rows;
    size_t columns;
    int64_t *value; /* rows * columns; TABLE_EMPTY where the field is empty */
} table_t;

#define TABLE_EMPTY INT64_MIN

/* Reads a whole file. Its header must begin with the names of the columns; fields beyond them are ignored. Reports the
 * first fault, with its line, and returns false; the table is then empty. Free it in either case. */
bool table_read(table_t *table, const table_column_t *columns, size_t count, const char *path);
void table_free(table_t *table);

static inline int64_t table_at(const table_t *table, size_t row, size_t column) {
    return table->value[row * table->columns + column];
}

#endif
