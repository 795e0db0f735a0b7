#include "frame_work.h"

#include <string.h>

#include "disparity/decoder.h"
#include "disparity/road_points.h"
#include "disparity/u_disparity.h"
#include "disparity/v_disparity.h"
#include "fixed_point/fixed_point.h"
#include "method_work.h"
#include "road/acceptance.h"
#include "road/refinement.h"

/* Fewer samples than this with a disparity, or in the free map, are no picture of a road. */
#define SAMPLES_MIN 64u

/* Cells that memset clears at the cost of one sample. */
#define CLEAR_SHARE 16

static uint16_t at_most(uint32_t next, int16_t end) {
    return (uint16_t)((next < (uint32_t)end) ? next : (uint32_t)end);
}

static uint32_t rows_a_slice(const roadpose_t *instance) {
    return ROADPOSE_SLICE_SAMPLES / (uint32_t)instance->grid.columns; /* columns <= 1024 */
}

static uint16_t rows_end(const roadpose_t *instance) {
    return at_most(instance->cursor + rows_a_slice(instance), instance->grid.rows);
}

static uint16_t columns_end(const roadpose_t *instance, uint32_t share) {
    const uint32_t columns = ROADPOSE_SLICE_SAMPLES * share / ROADPOSE_MAX_DISPARITY;
    return at_most(instance->cursor + columns, instance->grid.columns);
}

static void clear_slice(roadpose_t *instance) {
    const uint16_t end = columns_end(instance, CLEAR_SHARE);
    memset(instance->work.u_disparity.count[instance->cursor], 0,
           (size_t)(end - instance->cursor) * sizeof instance->work.u_disparity.count[0]);
    instance->cursor = end;
    if (end == instance->grid.columns) {
        roadpose_enter(instance, PHASE_U_DISPARITY);
    }
}

static void begin_row(roadpose_t *instance, uint16_t grid_row, roadpose_row_t *samples) {
    roadpose_row_begin(samples, &instance->decoder, &instance->frame, (uint32_t)grid_row * ROADPOSE_ROW_STEP,
                       instance->grid.columns, instance->row_q8);
}

static void u_disparity_slice(roadpose_t *instance) {
    const uint16_t end = rows_end(instance);
    for (uint16_t row = instance->cursor; row < end; row++) {
        roadpose_row_t samples;
        begin_row(instance, row, &samples);
        instance->pose.valid_samples +=
            roadpose_u_disparity_add_row(&instance->work.u_disparity, &samples, instance->grid.columns);
    }
    instance->cursor = end;
    if (end < instance->grid.rows) {
        return;
    }
    if (instance->pose.valid_samples < SAMPLES_MIN) {
        roadpose_finish(instance, ROADPOSE_STATUS_NO_DISPARITY);
    } else {
        roadpose_enter(instance, PHASE_FREE_MAP);
    }
}

static void free_map_slice(roadpose_t *instance) {
    const uint16_t end = columns_end(instance, 1);
    roadpose_free_rule_t rule;
    roadpose_free_rule(&rule, &instance->grid, &instance->settings);
    for (uint16_t column = instance->cursor; column < end; column++) {
        instance->pose.free_samples += roadpose_free_map_column(&instance->free_map, &instance->work.u_disparity,
                                                                &rule, &instance->grid, (int16_t)column);
    }
    instance->cursor = end;
    if (end < instance->grid.columns) {
        return;
    }
    if (instance->pose.free_samples < SAMPLES_MIN) {
        roadpose_finish(instance, ROADPOSE_STATUS_NO_ROAD);
    } else {
        const uint32_t total = instance->pose.free_samples;
        const uint32_t keep = (total < ROADPOSE_MAX_POINTS) ? total : ROADPOSE_MAX_POINTS;
        roadpose_thinning_begin(&instance->thinning, keep, total);
        roadpose_levels_open(&instance->moments);
        roadpose_enter(instance, PHASE_V_DISPARITY);
    }
}

static void v_disparity_slice(roadpose_t *instance) {
    const uint16_t end = rows_end(instance);
    for (uint16_t row = instance->cursor; row < end; row++) {
        roadpose_row_t samples;
        begin_row(instance, row, &samples);
        roadpose_v_disparity_row(&instance->v_disparity, &instance->points, &instance->free_map, &samples,
                                 instance->grid.columns, (int16_t)row, &instance->thinning);
    }
    instance->cursor = end;
    if (end == instance->grid.rows) {
        roadpose_enter(instance, (instance->settings.method == 1u) ? PHASE_PROFILE : PHASE_SORT_COUNT);
    }
}

/* Adds the rows of one slice to the moments. Returns false when the plane is none. */
static bool look_at_points(roadpose_t *instance, uint8_t round) {
    const uint16_t step = roadpose_refine_row_step(round, instance->points.count);
    const uint16_t end = at_most(instance->cursor + (uint32_t)step * rows_a_slice(instance), instance->grid.rows);
    if (instance->cursor == 0u) {
        if (!roadpose_road_rule(&instance->rule, &instance->plane, &instance->grid, &instance->settings, round)) {
            return false;
        }
        roadpose_moments_begin(&instance->moments, &instance->rule);
    }
    for (uint16_t row = instance->cursor; row < end; row = (uint16_t)(row + step)) {
        roadpose_moments_add_row(&instance->moments, &instance->points, &instance->plane, &instance->rule,
                                 &instance->grid, (int16_t)row);
    }
    instance->cursor = end;
    return true;
}

static void accept(roadpose_t *instance) {
    roadpose_accept(&instance->pose, &instance->plane, &instance->moments, &instance->grid, &instance->settings,
                    instance->roll_observed);
    const bool has_roll = (instance->pose.observed & ROADPOSE_OBSERVED_ROLL) != 0u;
    const bool has_corridor = instance->settings.corridor_half_width_mm != 0;
    roadpose_enter(instance, (has_roll && has_corridor && instance->settings.refine) ? PHASE_INNER : PHASE_DONE);
}

/* A plane may lean on a kerb with one side: then the lane's inner half says otherwise. */
static void inner_slice(roadpose_t *instance) {
    if (!look_at_points(instance, ROADPOSE_LOOK_INNER)) {
        roadpose_finish(instance, ROADPOSE_STATUS_NO_ROAD);
        return;
    }
    if (instance->cursor < (uint16_t)instance->grid.rows) {
        return;
    }
    roadpose_plane_t inner = instance->plane;
    bool roll_observed = false;
    const bool is_plane = roadpose_refine_step(&instance->moments, &inner, &roll_observed);
    if (is_plane && roll_observed &&
        roadpose_turned_too_far(&instance->plane, &inner, ROADPOSE_INNER_TURN_MAX_Q16)) {
        roadpose_finish(instance, ROADPOSE_STATUS_POOR_FIT);
    } else {
        roadpose_enter(instance, PHASE_DONE);
    }
}

/* The last step moves the plane by far less than the band, so its look stands for the assessment; unless the plane
 * followed a kerb: then the one within the noise band is the road's, and is looked at anew. */
static void refine_done(roadpose_t *instance) {
    if (roadpose_turned_too_far(&instance->noise_plane, &instance->plane, ROADPOSE_UNEVEN_TURN_MAX_Q16)) {
        instance->plane = instance->noise_plane;
        roadpose_enter(instance, PHASE_ASSESS);
    } else {
        accept(instance);
    }
}

static void refine_slice(roadpose_t *instance) {
    if (!look_at_points(instance, instance->round)) {
        roadpose_finish(instance, ROADPOSE_STATUS_NO_ROAD);
        return;
    }
    if (instance->cursor < (uint16_t)instance->grid.rows) {
        return;
    }
    if (!roadpose_refine_step(&instance->moments, &instance->plane, &instance->roll_observed)) {
        roadpose_finish(instance, ROADPOSE_STATUS_LITTLE_SUPPORT);
        return;
    }
    instance->cursor = 0;
    instance->round++;
    if (instance->round == ROADPOSE_REFINE_ROUNDS) {
        refine_done(instance);
        return;
    }
    roadpose_levels_judge(&instance->moments, &instance->settings);
    if (instance->round == ROADPOSE_UNEVEN_ROUND) {
        instance->noise_plane = instance->plane;
    }
}

/* A plane that was not refined is held against the widest band. One that goes back behind the uneven rounds comes from
 * few rows: one more step on all of them, within the noise band. */
static void assess_slice(roadpose_t *instance) {
    const bool refine = instance->settings.refine;
    if (!look_at_points(instance, refine ? ROADPOSE_LOOK_NOISE : ROADPOSE_LOOK_WIDE)) {
        roadpose_finish(instance, ROADPOSE_STATUS_NO_ROAD);
        return;
    }
    if (instance->cursor < (uint16_t)instance->grid.rows) {
        return;
    }
    if (refine && !roadpose_refine_step(&instance->moments, &instance->plane, &instance->roll_observed)) {
        roadpose_finish(instance, ROADPOSE_STATUS_LITTLE_SUPPORT);
    } else {
        accept(instance);
    }
}

void roadpose_work_slice(roadpose_t *instance) {
    switch (instance->phase) {
    case PHASE_CLEAR:
        clear_slice(instance);
        break;
    case PHASE_U_DISPARITY:
        u_disparity_slice(instance);
        break;
    case PHASE_FREE_MAP:
        free_map_slice(instance);
        break;
    case PHASE_V_DISPARITY:
        v_disparity_slice(instance);
        break;
    case PHASE_REFINE:
        refine_slice(instance);
        break;
    case PHASE_ASSESS:
        assess_slice(instance);
        break;
    case PHASE_INNER:
        inner_slice(instance);
        break;
    default:
        roadpose_method_slice(instance);
        break;
    }
}

uint32_t roadpose_work_slices_max(void) {
    const uint32_t rows_a_slice = ROADPOSE_SLICE_SAMPLES / ROADPOSE_MAX_GRID_COLUMNS;
    const uint32_t row_pass = (ROADPOSE_MAX_GRID_ROWS + rows_a_slice - 1u) / rows_a_slice;
    const uint32_t columns_a_slice = ROADPOSE_SLICE_SAMPLES / ROADPOSE_MAX_DISPARITY;
    const uint32_t column_pass = (ROADPOSE_MAX_GRID_COLUMNS + columns_a_slice - 1u) / columns_a_slice;
    /* clear and free map; u- and v-disparity, the refinement and two looks more. A narrower image than the limit has
     * fewer columns and so more rows a slice: never more slices. */
    return 2u * column_pass + (4u + ROADPOSE_REFINE_ROUNDS) * row_pass + roadpose_method_slices_max();
}
