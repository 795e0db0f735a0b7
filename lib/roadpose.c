#include "roadpose/roadpose.h"

#include "arguments.h"
#include "disparity/decoder.h"
#include "disparity/road_points.h"
#include "disparity/u_disparity.h"
#include "frame_work.h"
#include "method_work.h"
#include "road/ground_plane.h"

/* "ROAD": tells an initialised instance from memory with other content. */
#define READY_MARK UINT32_C(0x524F4144)

static bool is_ready(const roadpose_t *instance) {
    return instance->ready == READY_MARK;
}

static bool is_running(const roadpose_t *instance) {
    return instance->phase >= (uint8_t)PHASE_CLEAR;
}

/* Grid point next to the principal point, rounded; millipx >= 0. */
static int16_t nearest_grid_point(int32_t centre_millipx, int32_t step) {
    return (int16_t)((centre_millipx + 500 * step) / (1000 * step));
}

static void prepare_grid(roadpose_grid_t *grid, const roadpose_rig_t *rig) {
    grid->columns = (int16_t)((rig->width_px + ROADPOSE_COLUMN_STEP - 1) / ROADPOSE_COLUMN_STEP);
    grid->rows = (int16_t)((rig->height_px + ROADPOSE_ROW_STEP - 1) / ROADPOSE_ROW_STEP);
    grid->column_0 = nearest_grid_point(rig->cu_millipx, ROADPOSE_COLUMN_STEP);
    grid->row_0 = nearest_grid_point(rig->cv_millipx, ROADPOSE_ROW_STEP);
    grid->du_millipx = grid->column_0 * (1000 * ROADPOSE_COLUMN_STEP) - rig->cu_millipx;
    grid->dv_millipx = grid->row_0 * (1000 * ROADPOSE_ROW_STEP) - rig->cv_millipx;
    grid->focal_millipx = rig->focal_millipx;
    grid->baseline_um = rig->baseline_um;
}

roadpose_result_t roadpose_init(roadpose_t *instance, const roadpose_rig_t *rig,
                                const roadpose_disparity_format_t *format, const roadpose_settings_t *settings) {
    if (instance == NULL || rig == NULL || format == NULL) {
        return ROADPOSE_ERROR_NULL;
    }
    roadpose_settings_t chosen;
    roadpose_settings_default(&chosen);
    if (settings != NULL) {
        chosen = *settings;
    }
    roadpose_decoder_t decoder;
    roadpose_result_t result = roadpose_check_rig(rig);
    if (result == ROADPOSE_OK && !roadpose_decoder_prepare(&decoder, format)) {
        result = ROADPOSE_ERROR_FORMAT;
    }
    if (result == ROADPOSE_OK) {
        result = roadpose_check_settings(&chosen);
    }
    if (result != ROADPOSE_OK) {
        return result;
    }
    instance->ready = READY_MARK;
    instance->settings = chosen;
    instance->decoder = decoder;
    instance->width_px = rig->width_px;
    instance->height_px = rig->height_px;
    instance->has_confidence_image = format->has_confidence_image;
    prepare_grid(&instance->grid, rig);
    roadpose_plane_box(&instance->box, &instance->grid, &instance->settings);
    roadpose_enter(instance, PHASE_IDLE);
    return ROADPOSE_OK;
}

roadpose_result_t roadpose_frame_begin(roadpose_t *instance, const roadpose_frame_t *frame) {
    if (instance == NULL || frame == NULL) {
        return ROADPOSE_ERROR_NULL;
    }
    if (!is_ready(instance) || is_running(instance)) {
        return ROADPOSE_ERROR_ORDER;
    }
    const roadpose_result_t result = roadpose_check_frame(instance, frame);
    if (result != ROADPOSE_OK) {
        return result;
    }
    instance->frame = *frame;
    if (!instance->has_confidence_image) {
        instance->frame.confidence = NULL; /* a second image that the format does not use */
    }
    instance->random = instance->settings.seed; /* each frame anew: the result does not depend on the frames before */
    instance->pose = (roadpose_pose_t){0};
    roadpose_points_clear(&instance->points);
    roadpose_enter(instance, PHASE_CLEAR);
    return ROADPOSE_OK;
}

static void let_go_of_buffers(roadpose_t *instance) {
    instance->frame.samples = NULL;
    instance->frame.confidence = NULL;
}

roadpose_result_t roadpose_frame_slice(roadpose_t *instance) {
    if (instance == NULL) {
        return ROADPOSE_ERROR_NULL;
    }
    if (!is_ready(instance) || !is_running(instance)) {
        return ROADPOSE_ERROR_ORDER;
    }
    roadpose_work_slice(instance);
    if (is_running(instance)) {
        return ROADPOSE_MORE;
    }
    let_go_of_buffers(instance);
    return ROADPOSE_OK;
}

roadpose_result_t roadpose_frame_pose(const roadpose_t *instance, roadpose_pose_t *pose) {
    if (instance == NULL || pose == NULL) {
        return ROADPOSE_ERROR_NULL;
    }
    if (!is_ready(instance) || instance->phase != (uint8_t)PHASE_DONE) {
        return ROADPOSE_ERROR_ORDER;
    }
    *pose = instance->pose;
    return ROADPOSE_OK;
}

roadpose_result_t roadpose_frame_cancel(roadpose_t *instance) {
    if (instance == NULL) {
        return ROADPOSE_ERROR_NULL;
    }
    if (!is_ready(instance)) {
        return ROADPOSE_ERROR_ORDER;
    }
    let_go_of_buffers(instance);
    roadpose_enter(instance, PHASE_IDLE);
    return ROADPOSE_OK;
}

roadpose_result_t roadpose_process(roadpose_t *instance, const roadpose_frame_t *frame, roadpose_pose_t *pose) {
    if (pose == NULL) {
        return ROADPOSE_ERROR_NULL;
    }
    roadpose_result_t result = roadpose_frame_begin(instance, frame);
    if (result != ROADPOSE_OK) {
        return result;
    }
    do {
        result = roadpose_frame_slice(instance);
    } while (result == ROADPOSE_MORE);
    return roadpose_frame_pose(instance, pose);
}

uint32_t roadpose_slices_max(void) {
    return roadpose_work_slices_max();
}

size_t roadpose_state_bytes(void) {
    return sizeof(roadpose_t);
}

const char *roadpose_status_word(uint8_t status) {
    static const char *const WORDS[ROADPOSE_STATUS_COUNT] = {
        "ok", "no_disparity", "no_road", "little_support", "short_range", "poor_fit", "outside_limits",
    };
    return (status < ROADPOSE_STATUS_COUNT) ? WORDS[status] : "unknown";
}

/* Points are there once the free map and the v-disparity are, whatever came after. */
static bool has_histograms(const roadpose_t *instance) {
    return instance != NULL && is_ready(instance) && instance->phase == (uint8_t)PHASE_DONE &&
           instance->points.count != 0u;
}

bool roadpose_is_free(const roadpose_t *instance, uint16_t grid_column, uint16_t disparity_px) {
    return has_histograms(instance) && (int32_t)grid_column < instance->grid.columns &&
           disparity_px < ROADPOSE_MAX_DISPARITY &&
           roadpose_cell_is_free(&instance->free_map, grid_column, disparity_px);
}

uint16_t roadpose_v_disparity_free(const roadpose_t *instance, uint16_t grid_row, uint16_t disparity_px) {
    if (!has_histograms(instance) || (int32_t)grid_row >= instance->grid.rows ||
        disparity_px >= ROADPOSE_MAX_DISPARITY) {
        return 0;
    }
    return instance->v_disparity.count[grid_row][disparity_px];
}
