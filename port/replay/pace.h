/* How fast a recording plays. */
#ifndef REPLAY_PACE_H
#define REPLAY_PACE_H

#include <stdbool.h>
#include <stdint.h>

typedef struct {
    uint32_t speed_permille; /* 1000: as recorded; 0: as fast as possible */
    uint64_t start_us;       /* of the machine's clock, when the recording began */
    uint64_t frame_us;       /* of the machine's clock, when this frame began */
} pace_t;

/* Starts the clock. */
void pace_begin(pace_t *pace, uint32_t speed_permille);

/* A frame begins now. */
void pace_frame(pace_t *pace);

/* Sleeps for a millisecond at most, and returns true, while it is too early for the frame after the one at time_us,
 * which has its time at next_us. Without a speed, or with no frame to come (is_last), it waits only while something
 * is_pending, and no longer than from one frame to the next. *now_us becomes the time of the recording. */
bool pace_wait(const pace_t *pace, uint64_t time_us, uint64_t next_us, bool is_last, bool is_pending, uint64_t *now_us);

#endif
