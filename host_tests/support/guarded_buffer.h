/* Memory with guard bytes before and after it, that nobody may touch. */
#ifndef ROADPOSE_TEST_GUARDED_BUFFER_H
#define ROADPOSE_TEST_GUARDED_BUFFER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct {
    uint8_t *block;
    uint8_t *bytes; /* what the test uses; misaligned by `offset` from malloc's alignment */
    size_t count;
    size_t offset;
} guarded_buffer_t;

guarded_buffer_t guarded_buffer(size_t count, size_t offset); /* ends the program when memory is out */
bool guards_are_whole(const guarded_buffer_t *buffer);
void free_guarded_buffer(guarded_buffer_t *buffer);

#endif
