#include "guarded_buffer.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { GUARD = 64, MARK = 0xA5 };

guarded_buffer_t guarded_buffer(size_t count, size_t offset) {
    guarded_buffer_t buffer = {malloc(GUARD + offset + count + GUARD), NULL, count, offset};
    if (!buffer.block) {
        perror("guarded_buffer");
        exit(EXIT_FAILURE);
    }
    memset(buffer.block, MARK, GUARD + offset + count + GUARD);
    buffer.bytes = buffer.block + GUARD + offset;
    return buffer;
}

static bool all_marked(const uint8_t *bytes, size_t count) {
    for (size_t i = 0; i < count; i++)
        if (bytes[i] != MARK) return false;
    return true;
}

bool guards_are_whole(const guarded_buffer_t *buffer) {
    return all_marked(buffer->block, GUARD + buffer->offset) && all_marked(buffer->bytes + buffer->count, GUARD);
}

void free_guarded_buffer(guarded_buffer_t *buffer) {
    free(buffer->block);
    buffer->block = NULL;
}
