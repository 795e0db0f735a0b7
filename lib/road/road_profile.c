#include "road/road_profile.h"

#include "fixed_point/fixed_point.h"

/* A cell of level D holds disparities D...D + 1: its middle, in Q24. */
#define LEVEL_Q24(level) (((int64_t)(level) << 24) + (INT64_C(1) << 23))

/* Draws a level of a row with the probability of its count. Returns -1 for an empty row. */
static int32_t draw_level(const roadpose_count_t *count, uint32_t *random) {
    uint32_t total = 0;
    for (int32_t level = 0; level < ROADPOSE_MAX_DISPARITY; level++) {
        total += count[level];
    }
    if (total == 0u) {
        return -1;
    }
    uint32_t left = roadpose_lcg_below(random, total);
    int32_t level = 0;
    while (left >= count[level]) { /* left < total, so it ends within the row */
        left -= count[level];
        level++;
    }
    return level;
}

/* Level that the line predicts for a row, or -1 outside the histogram. |b| <= 2^31, |y| <= 2^10. */
static int32_t predicted_level(const roadpose_plane_t *line, int32_t y) {
    const int64_t level = roadpose_floor_shift((int64_t)line->b_q24 * y + line->c_q24, 24);
    return (level < 0 || level >= ROADPOSE_MAX_DISPARITY) ? -1 : (int32_t)level;
}

/* Counts on the line and next to it. At most 2^10 rows * 4 * 2^10 counts. */
static int32_t score_line(const roadpose_v_disparity_t *histogram, const roadpose_grid_t *grid,
                          const roadpose_plane_t *line) {
    int32_t score = 0;
    for (int16_t row = 0; row < grid->rows; row++) {
        const int32_t level = predicted_level(line, row - grid->row_0);
        if (level < 0) {
            continue;
        }
        const roadpose_count_t *count = histogram->count[row];
        score += 2 * (int32_t)count[level];
        score += (level > 0) ? (int32_t)count[level - 1] : 0;
        score += (level + 1 < ROADPOSE_MAX_DISPARITY) ? (int32_t)count[level + 1] : 0;
    }
    return score;
}

void roadpose_profile_try(const roadpose_v_disparity_t *histogram, const roadpose_grid_t *grid,
                          const roadpose_plane_box_t *box, uint32_t *random, roadpose_plane_t *best,
                          int32_t *best_score) {
    const int32_t first = (int32_t)roadpose_lcg_below(random, (uint32_t)grid->rows);
    const int32_t second = (int32_t)roadpose_lcg_below(random, (uint32_t)grid->rows);
    const int32_t first_level = draw_level(histogram->count[first], random);
    const int32_t second_level = draw_level(histogram->count[second], random);
    if (first == second || first_level < 0 || second_level < 0) {
        return;
    }
    roadpose_plane_t line = {0, 0, 0};
    const int64_t slope = ((int64_t)(second_level - first_level) * (INT64_C(1) << 24)) / (second - first);
    line.b_q24 = roadpose_clamp32(slope);
    line.c_q24 = LEVEL_Q24(first_level) - (int64_t)line.b_q24 * (first - grid->row_0);
    if (!roadpose_profile_in_box(&line, box)) {
        return;
    }
    const int32_t score = score_line(histogram, grid, &line);
    if (score > *best_score) {
        *best_score = score;
        *best = line;
    }
}

/* Sums of counts n, rows y and residuals r (Q8) over the cells near the line. n <= 2^20 counts in all,
 * |y| <= 2^10, |r| <= 3 * 2^8: every sum below 2^41. */
typedef struct {
    int64_t n, y, yy, r, yr;
} profile_sums_t;

static void add_row(profile_sums_t *sums, const roadpose_count_t *count, const roadpose_plane_t *line, int32_t y,
                    int32_t first_level, int32_t width) {
    const int64_t at_q8 = roadpose_floor_shift((int64_t)line->b_q24 * y + line->c_q24, 16);
    const int32_t middle = predicted_level(line, y);
    if (middle - width < first_level || middle + width >= ROADPOSE_MAX_DISPARITY) {
        return; /* a band cut off on one side would pull the line */
    }
    for (int32_t level = middle - width; level <= middle + width; level++) {
        const int64_t n = count[level];
        const int64_t r = (int64_t)level * 256 + 128 - at_q8;
        sums->n += n;
        sums->y += n * y;
        sums->yy += n * y * y;
        sums->r += n * r;
        sums->yr += n * r * y;
    }
}

bool roadpose_profile_fit(const roadpose_v_disparity_t *histogram, const roadpose_grid_t *grid, int32_t first_level,
                          int32_t width, roadpose_plane_t *line) {
    profile_sums_t s = {0, 0, 0, 0, 0};
    for (int16_t row = 0; row < grid->rows; row++) {
        add_row(&s, histogram->count[row], line, row - grid->row_0, first_level, width);
    }
    /* n * yy < 2^20 * 2^40; for the ratio the denominator must be below 2^62 */
    const int64_t spread = s.n * s.yy - s.y * s.y;
    if (s.n == 0 || spread <= 0) {
        return false;
    }
    const int64_t slope = roadpose_clamp(roadpose_ratio(s.n * s.yr - s.y * s.r, spread, 16), -(1 << 30), 1 << 30);
    const int64_t offset = (s.r * 65536 - slope * s.y) / s.n;
    line->b_q24 = roadpose_clamp32(line->b_q24 + slope);
    line->c_q24 = roadpose_clamp(line->c_q24 + offset, -(INT64_C(1) << 40), INT64_C(1) << 40);
    return true;
}
