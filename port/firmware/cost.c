#include "cost.h"

#include <inttypes.h>
#include <stdio.h>

void cost_add_slice(cost_t *cost, uint32_t instructions) {
    cost->frame += instructions;
    if (instructions > cost->worst_slice)
        cost->worst_slice = instructions;
}

void cost_end_frame(cost_t *cost) {
    cost->frames++;
    cost->instructions += cost->frame;
    if (cost->frame > cost->worst_frame)
        cost->worst_frame = cost->frame;
    cost->frame = 0;
}

void cost_print(const cost_t *cost, const char *name) {
    (void)fprintf(stderr, "%s frames %" PRIu32 " instructions %" PRIu64 " worst_frame %" PRIu32 " worst_slice %" PRIu32 "\n",
                  name, cost->frames, cost->instructions, cost->worst_frame, cost->worst_slice);
}
