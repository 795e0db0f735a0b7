#include "pace.h"

#include <stddef.h>
#include <time.h>

#define SLEEP_NS 1000000L

static uint64_t clock_us(void) {
    struct timespec now;

    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint64_t)now.tv_sec * 1000000u + (uint64_t)now.tv_nsec / 1000u;
}

static void sleep_a_little(void) {
    const struct timespec little = {0, SLEEP_NS};

    (void)nanosleep(&little, NULL); /* a signal only wakes it earlier */
}

void pace_begin(pace_t *pace, uint32_t speed_permille) {
    pace->speed_permille = speed_permille;
    pace->start_us = clock_us();
    pace->frame_us = pace->start_us;
}

void pace_frame(pace_t *pace) {
    pace->frame_us = clock_us();
}

bool pace_wait(const pace_t *pace, uint64_t time_us, uint64_t next_us, bool is_last, bool is_pending,
               uint64_t *now_us) {
    const bool is_paced = pace->speed_permille > 0 && !is_last;
    const uint64_t scale = pace->speed_permille > 0 ? pace->speed_permille : 1000u;
    const uint64_t elapsed_us = (clock_us() - (is_paced ? pace->start_us : pace->frame_us)) * scale / 1000u;

    *now_us = is_paced ? elapsed_us : time_us + elapsed_us;
    *now_us = *now_us > time_us ? *now_us : time_us;
    if (*now_us >= next_us || (!is_paced && !is_pending))
        return false;
    sleep_a_little();
    return true;
}
