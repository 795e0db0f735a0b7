#include "fixed_point/fixed_point.h"

#define ROUNDS 30
#define HALF_TURN_NRAD INT64_C(3141592654)

/* atan(2^-i) in nano-radians, rounded; their errors add up to less than 15 nrad. */
static const int32_t ANGLE_NRAD[ROUNDS] = {
    785398163, 463647609, 244978663, 124354995, 62418810, 31239833,
    15623729, 7812341, 3906230, 1953123, 976562, 488281,
    244141, 122070, 61035, 30518, 15259, 7629,
    3815, 1907, 954, 477, 238, 119,
    60, 30, 15, 7, 4, 2,
};

/* Angle of (x, y) for x >= 0, in nano-radians: turns the point onto the x axis and adds up the turns.
 * |x|, |y| <= 2^30 on entry; a turn lengthens by at most 1.647 in all, so |x|, |y| < 1.647 * sqrt(2) * 2^30 < 2^32. */
static int64_t right_half(int64_t y, int64_t x) {
    int64_t angle = 0;
    for (unsigned i = 0; i < ROUNDS; i++) {
        const int64_t dx = roadpose_floor_shift(y, i);
        const int64_t dy = roadpose_floor_shift(x, i);
        if (y >= 0) {
            x += dx;
            y -= dy;
            angle += ANGLE_NRAD[i];
        } else {
            x -= dx;
            y += dy;
            angle -= ANGLE_NRAD[i];
        }
    }
    return angle;
}

int32_t roadpose_arctangent(int32_t y, int32_t x) {
    if (x == 0 && y == 0) {
        return 0;
    }
    int64_t angle = right_half((x < 0) ? -(int64_t)y : (int64_t)y, roadpose_abs(x));
    if (x < 0) {
        angle += (y >= 0) ? HALF_TURN_NRAD : -HALF_TURN_NRAD;
    }
    const int64_t half = (angle >= 0) ? 500 : -500;
    return (int32_t)((angle + half) / 1000);
}
