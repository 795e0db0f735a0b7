/* What the frames cost in executed instructions. */
#ifndef ROADPOSE_COST_H
#define ROADPOSE_COST_H

#include <stdint.h>

typedef struct {
    uint32_t frames;
    uint64_t instructions; /* of all frames */
    uint32_t worst_frame;
    uint32_t worst_slice;
    uint32_t frame; /* of the running frame, so far */
} cost_t;

/* Adds one call of the cyclic task. */
void cost_add_slice(cost_t *cost, uint32_t instructions);

/* Ends a frame. */
void cost_end_frame(cost_t *cost);

/* Words of a line on standard error. */
void cost_print(const cost_t *cost, const char *name);

#endif
