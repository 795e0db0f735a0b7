/* u-disparity: how often each disparity level occurs in each column; obstacles stand out as tall columns of one
 * level. From it the free map (paper, section 3.1). */
#ifndef ROADPOSE_U_DISPARITY_H
#define ROADPOSE_U_DISPARITY_H

#include "disparity/decoder.h"

/* Counts one row; returns how many samples carried a disparity. Each cell grows by at most one a call. */
uint32_t roadpose_u_disparity_add_row(roadpose_u_disparity_t *histogram, const roadpose_row_t *samples, int16_t columns);

/* Where road is looked for: what the settings mean for the cells of the u-disparity. */
typedef struct {
    int32_t road_count;         /* counts that the road itself may reach in two levels of a column */
    int32_t obstacle_um;        /* what an obstacle adds to it: obstacle_um * level / per_count_um; 0: no obstacles */
    int32_t per_count_um;       /* baseline * row step */
    int32_t level_min;          /* first level within the range */
    int64_t half_width_um;      /* of the widened corridor; 0: no limit */
} roadpose_free_rule_t;

void roadpose_free_rule(roadpose_free_rule_t *rule, const roadpose_grid_t *grid, const roadpose_settings_t *settings);

/* Makes column `column` of the free map; returns the samples in its free cells. */
uint32_t roadpose_free_map_column(roadpose_free_map_t *free_map, const roadpose_u_disparity_t *histogram,
                                  const roadpose_free_rule_t *rule, const roadpose_grid_t *grid, int16_t column);

static inline bool roadpose_cell_is_free(const roadpose_free_map_t *free_map, unsigned column, unsigned level) {
    return ((free_map->bits[column][level >> 5] >> (level & 31u)) & 1u) != 0u;
}

#endif
