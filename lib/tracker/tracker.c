#include "roadpose/tracker.h"

#include <string.h>

#include "tracker/block_match.h"
#include "tracker/corners.h"
#include "tracker/sub_pixel.h"

#if ROADPOSE_TRACKER

#define READY_MARK UINT32_C(0x54524B31)
#define SIDE_MIN_PX 64

void roadpose_tracker_settings_default(roadpose_tracker_settings_t *settings) {
    if (settings != NULL) {
        *settings = (roadpose_tracker_settings_t){.corner_min = 800, .mismatch_max_percent = 40};
    }
}

roadpose_result_t roadpose_tracker_init(roadpose_tracker_t *tracker, const roadpose_tracker_settings_t *settings) {
    roadpose_tracker_settings_t chosen;
    if (tracker == NULL) {
        return ROADPOSE_ERROR_NULL;
    }
    roadpose_tracker_settings_default(&chosen);
    if (settings != NULL) {
        chosen = *settings;
    }
    if (chosen.corner_min < 1u || chosen.corner_min > 60000u || chosen.mismatch_max_percent < 1u ||
        chosen.mismatch_max_percent > 100u) {
        return ROADPOSE_ERROR_SETTINGS;
    }
    memset(tracker, 0, sizeof *tracker);
    tracker->settings = chosen;
    tracker->ready = READY_MARK;
    return ROADPOSE_OK;
}

static roadpose_result_t check_images(const roadpose_grey_t *previous, const roadpose_grey_t *present) {
    if (previous->pixels == NULL || present->pixels == NULL) {
        return ROADPOSE_ERROR_NULL;
    }
    if (previous->width_px != present->width_px || previous->height_px != present->height_px ||
        previous->width_px < SIDE_MIN_PX || previous->width_px > ROADPOSE_MAX_WIDTH ||
        previous->height_px < SIDE_MIN_PX || previous->height_px > ROADPOSE_MAX_HEIGHT) {
        return ROADPOSE_ERROR_SIZE;
    }
    const bool strides = previous->stride_bytes >= previous->width_px && present->stride_bytes >= present->width_px;
    return strides ? ROADPOSE_OK : ROADPOSE_ERROR_STRIDE;
}

static bool track_of_cell(roadpose_tracker_t *tracker, const roadpose_grey_t *previous, const roadpose_grey_t *present,
                          unsigned cell, roadpose_track_t *track) {
    roadpose_corner_t corner;
    roadpose_corner_t found;
    return roadpose_corner_of_cell(previous, cell % ROADPOSE_TRACKER_COLUMNS, cell / ROADPOSE_TRACKER_COLUMNS,
                                   tracker->settings.corner_min, &corner) &&
           roadpose_block_match(tracker, previous, present, &corner, &found) &&
           roadpose_sub_pixel(tracker, previous, present, &corner, &found, track);
}

roadpose_result_t roadpose_tracker_track(roadpose_tracker_t *tracker, const roadpose_grey_t *previous,
                                         const roadpose_grey_t *present, roadpose_track_t *tracks, size_t capacity,
                                         size_t *count) {
    if (tracker == NULL || previous == NULL || present == NULL || count == NULL || (tracks == NULL && capacity != 0)) {
        return ROADPOSE_ERROR_NULL;
    }
    if (tracker->ready != READY_MARK) {
        return ROADPOSE_ERROR_ORDER;
    }
    const roadpose_result_t result = check_images(previous, present);
    if (result != ROADPOSE_OK) {
        return result;
    }
    size_t written = 0;
    for (unsigned cell = 0; cell < ROADPOSE_TRACKER_CELLS && written < capacity; cell++) {
        roadpose_track_t track;
        if (track_of_cell(tracker, previous, present, cell, &track)) {
            tracks[written] = track;
            written++;
        }
    }
    *count = written;
    return ROADPOSE_OK;
}

#endif
