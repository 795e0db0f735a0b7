#include "disparity/u_disparity.h"

#include <string.h>

#include "disparity/ground_range.h"
#include "fixed_point/fixed_point.h"

/* The corridor is widened by half while the plane is not known: a rolled rig sees its lane aside. */
#define WIDENED_NUMERATOR 3
#define WIDENED_DENOMINATOR 2

/* 1 / (cos 25 deg * cos 15 deg) = 1.142: how much roll and pitch lengthen the rows of one level. */
#define TILT_PERCENT 115

/* Inlined with a constant for swap_bytes: a loop of its own for each byte order. */
static inline uint32_t add_row(roadpose_u_disparity_t *histogram, roadpose_row_t samples, bool swap_bytes,
                               int16_t columns) {
    uint32_t valid = 0;
    for (int16_t i = 0; i < columns; i++) {
        uint32_t disparity_q16;
        if (roadpose_row_take(&samples, swap_bytes, &disparity_q16)) {
            roadpose_count_t *cell = &histogram->count[i][disparity_q16 >> 16];
            *cell = (roadpose_count_t)(*cell + 1u); /* at most once for each of <= 255 (65535) grid rows */
            valid++;
        }
    }
    return valid;
}

uint32_t roadpose_u_disparity_add_row(roadpose_u_disparity_t *histogram, const roadpose_row_t *samples, int16_t columns) {
    return samples->swap_bytes ? add_row(histogram, *samples, true, columns)
                               : add_row(histogram, *samples, false, columns);
}

void roadpose_free_rule(roadpose_free_rule_t *rule, const roadpose_grid_t *grid, const roadpose_settings_t *settings) {
    rule->per_count_um = grid->baseline_um * ROADPOSE_ROW_STEP; /* <= 2e6 * 16 */
    rule->obstacle_um = settings->obstacle_height_mm * 1000;    /* <= 5e6 */
    /* A level of road is height / (baseline * n_y) rows high; two levels, the tallest rig: 5e6 * 2.3 < 2^24. */
    rule->road_count = 1 + (settings->height_max_um / 100 * (2 * TILT_PERCENT)) / rule->per_count_um;
    rule->half_width_um =
        (int64_t)settings->corridor_half_width_mm * 1000 * WIDENED_NUMERATOR / WIDENED_DENOMINATOR;
    /* One level more than the range asks for, so that noise does not cut the far end. */
    const int32_t level = roadpose_range_min_q8(grid, settings) / 256 - 1;
    rule->level_min = (level > 0) ? level : 0;
}

/* An obstacle of height H shows H * d / B rows of one disparity; matching noise spreads them over two levels. */
static bool is_obstacle(const roadpose_count_t *count, int32_t level, const roadpose_free_rule_t *rule) {
    if (rule->obstacle_um == 0) {
        return false;
    }
    const int32_t before = (level > 0) ? count[level - 1] : 0;
    const int32_t after = (level + 1 < ROADPOSE_MAX_DISPARITY) ? count[level + 1] : 0;
    const int32_t pair = count[level] + ((before > after) ? before : after);
    /* obstacle_um * level <= 5e6 * 256 < 2^31 */
    return pair > rule->road_count + rule->obstacle_um * level / rule->per_count_um;
}

/* First level of the column that lies in the corridor: |u - cu| B <= half width * d, where the far side of a level,
 * d = level + 1, counts. lateral <= 2^11 px * 2^21 um. */
static int32_t first_free_level(const roadpose_free_rule_t *rule, const roadpose_grid_t *grid, int16_t column) {
    const int32_t offset_px = (column - grid->column_0) * ROADPOSE_COLUMN_STEP;
    const int64_t lateral_um_px = roadpose_abs((int64_t)offset_px * grid->baseline_um);
    if (rule->half_width_um == 0 || lateral_um_px <= rule->half_width_um) {
        return rule->level_min;
    }
    const int64_t first = (lateral_um_px - 1) / rule->half_width_um;
    return (first > rule->level_min) ? (int32_t)roadpose_clamp(first, 0, ROADPOSE_MAX_DISPARITY) : rule->level_min;
}

uint32_t roadpose_free_map_column(roadpose_free_map_t *free_map, const roadpose_u_disparity_t *histogram,
                                  const roadpose_free_rule_t *rule, const roadpose_grid_t *grid, int16_t column) {
    const roadpose_count_t *count = histogram->count[column];
    uint32_t *bits = free_map->bits[column];
    uint32_t samples = 0;
    memset(bits, 0, sizeof free_map->bits[column]);
    for (int32_t level = first_free_level(rule, grid, column); level < ROADPOSE_MAX_DISPARITY; level++) {
        if (count[level] != 0u && !is_obstacle(count, level, rule)) {
            bits[level >> 5] |= UINT32_C(1) << ((unsigned)level & 31u);
            samples += count[level];
        }
    }
    return samples;
}
