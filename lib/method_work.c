#include "method_work.h"

#include "disparity/ground_range.h"
#include "disparity/road_points.h"
#include "road/acceptance.h"
#include "road/plane_ransac.h"
#include "road/road_profile.h"
#include "road/slope_cloud.h"

/* Tries of a pair that cost what ROADPOSE_SLICE_SAMPLES samples cost. */
#define PAIR_TRIES_A_SLICE 128u
#define PROFILE_FIT_ROUNDS 3u
#define INTERCEPT_FIT_ROUNDS 2u

/* Fewer pairs, or fewer that agree, are no road. */
#define PAIRS_MIN 16u

void roadpose_enter(roadpose_t *instance, roadpose_phase_t phase) {
    instance->phase = (uint8_t)phase;
    instance->cursor = 0;
    instance->round = 0;
    instance->best_score = 0;
}

void roadpose_finish(roadpose_t *instance, roadpose_status_t status) {
    roadpose_refuse(&instance->pose, status);
    roadpose_enter(instance, PHASE_DONE);
}

/* The method found its plane. */
static void method_done(roadpose_t *instance, bool roll_observed) {
    instance->roll_observed = roll_observed;
    roadpose_enter(instance, instance->settings.refine ? PHASE_REFINE : PHASE_ASSESS);
}

static void profile_slice(roadpose_t *instance) {
    roadpose_profile_try(&instance->v_disparity, &instance->grid, &instance->box, &instance->random, &instance->plane,
                         &instance->best_score);
    instance->cursor++;
    if (instance->cursor < ROADPOSE_PROFILE_HYPOTHESES) {
        return;
    }
    if (instance->best_score == 0) {
        roadpose_finish(instance, ROADPOSE_STATUS_NO_ROAD);
    } else {
        roadpose_enter(instance, PHASE_PROFILE_FIT);
    }
}

static void profile_fit_slice(roadpose_t *instance) {
    const int32_t first_level = roadpose_range_min_q8(&instance->grid, &instance->settings) / 256;
    const int32_t width = (instance->round == 0u) ? 2 : 1; /* levels on either side: first what the hypothesis asks */
    if (!roadpose_profile_fit(&instance->v_disparity, &instance->grid, first_level, width, &instance->plane)) {
        roadpose_finish(instance, ROADPOSE_STATUS_NO_ROAD);
        return;
    }
    instance->round++;
    if (instance->round == PROFILE_FIT_ROUNDS) {
        method_done(instance, false);
    }
}

static void sort_slice(roadpose_t *instance) {
    const uint32_t next = (uint32_t)instance->cursor + ROADPOSE_SLICE_SAMPLES;
    const uint16_t end = (uint16_t)((next < instance->points.count) ? next : instance->points.count);
    const bool counting = instance->phase == (uint8_t)PHASE_SORT_COUNT;
    if (instance->cursor == 0u) {
        roadpose_thinning_begin(&instance->thinning, instance->settings.points_percent, 100);
        if (counting) {
            roadpose_cloud_clear(&instance->work.cloud);
        }
    }
    if (counting) {
        roadpose_cloud_count(&instance->work.cloud, &instance->points, instance->cursor, end, &instance->thinning);
    } else {
        roadpose_cloud_place(&instance->work.cloud, &instance->points, instance->cursor, end, &instance->thinning);
    }
    instance->cursor = end;
    if (end == instance->points.count) {
        roadpose_enter(instance, counting ? PHASE_SORT_PLACES : PHASE_PAIRS);
    }
}

static void pairs_slice(roadpose_t *instance) {
    for (uint32_t i = 0; i < PAIR_TRIES_A_SLICE; i++) {
        roadpose_cloud_try_pair(&instance->work.cloud, &instance->points, &instance->grid, &instance->random);
    }
    instance->cursor = (uint16_t)(instance->cursor + PAIR_TRIES_A_SLICE);
    if (instance->cursor < ROADPOSE_PAIR_TRIES && instance->work.cloud.pairs < ROADPOSE_MAX_PAIRS) {
        return;
    }
    if (instance->work.cloud.pairs < PAIRS_MIN) {
        roadpose_finish(instance, ROADPOSE_STATUS_NO_ROAD);
    } else {
        roadpose_enter(instance, PHASE_SLOPE);
    }
}

static void slope_slice(roadpose_t *instance) {
    roadpose_slope_try(&instance->work.cloud, &instance->box, &instance->random, &instance->slope_q16, &instance->best_score);
    instance->cursor++;
    if (instance->cursor < ROADPOSE_SLOPE_HYPOTHESES) {
        return;
    }
    if (instance->best_score == 0) {
        roadpose_finish(instance, ROADPOSE_STATUS_NO_ROAD);
    } else {
        roadpose_enter(instance, PHASE_SLOPE_FIT);
    }
}

static void slope_fit_slice(roadpose_t *instance) {
    if (roadpose_slope_fit(&instance->work.cloud, &instance->box, &instance->slope_q16) < PAIRS_MIN) {
        roadpose_finish(instance, ROADPOSE_STATUS_NO_ROAD);
    } else {
        roadpose_enter(instance, PHASE_INTERCEPT);
    }
}

static void intercept_slice(roadpose_t *instance) {
    roadpose_intercept_try(&instance->work.cloud, &instance->box, instance->slope_q16, &instance->random, &instance->plane,
                           &instance->best_score);
    instance->cursor++;
    if (instance->cursor < ROADPOSE_INTERCEPT_HYPOTHESES) {
        return;
    }
    if (instance->best_score == 0) {
        roadpose_finish(instance, ROADPOSE_STATUS_NO_ROAD);
    } else {
        roadpose_enter(instance, PHASE_INTERCEPT_FIT);
    }
}

static void intercept_fit_slice(roadpose_t *instance) {
    const uint16_t agree = roadpose_intercept_fit(&instance->work.cloud, instance->slope_q16, &instance->plane);
    if (agree < PAIRS_MIN) {
        roadpose_finish(instance, ROADPOSE_STATUS_NO_ROAD);
        return;
    }
    instance->round++;
    if (instance->round == INTERCEPT_FIT_ROUNDS) {
        method_done(instance, true);
    }
}

void roadpose_method_slice(roadpose_t *instance) {
    switch (instance->phase) {
    case PHASE_PROFILE:
        profile_slice(instance);
        break;
    case PHASE_PROFILE_FIT:
        profile_fit_slice(instance);
        break;
    case PHASE_SORT_COUNT:
    case PHASE_SORT_PLACE:
        sort_slice(instance);
        break;
    case PHASE_SORT_PLACES:
        roadpose_cloud_places(&instance->work.cloud);
        roadpose_enter(instance, PHASE_SORT_PLACE);
        break;
    case PHASE_PAIRS:
        pairs_slice(instance);
        break;
    case PHASE_SLOPE:
        slope_slice(instance);
        break;
    case PHASE_SLOPE_FIT:
        slope_fit_slice(instance);
        break;
    case PHASE_INTERCEPT:
        intercept_slice(instance);
        break;
    default:
        intercept_fit_slice(instance);
        break;
    }
}

static uint32_t slices_of(uint32_t work, uint32_t a_slice) {
    return (work + a_slice - 1u) / a_slice;
}

uint32_t roadpose_method_slices_max(void) {
    const uint32_t profile = ROADPOSE_PROFILE_HYPOTHESES + PROFILE_FIT_ROUNDS;
    const uint32_t sort = 2u * slices_of(ROADPOSE_MAX_POINTS, ROADPOSE_SLICE_SAMPLES) + 1u;
    const uint32_t cloud = sort + slices_of(ROADPOSE_PAIR_TRIES, PAIR_TRIES_A_SLICE) + ROADPOSE_SLOPE_HYPOTHESES + 1u +
                           ROADPOSE_INTERCEPT_HYPOTHESES + INTERCEPT_FIT_ROUNDS;
    return (profile > cloud) ? profile : cloud;
}
