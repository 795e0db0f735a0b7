#include "motion.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "pgm.h"

#define MICRO INT64_C(1000000)
#define Q8_LIMIT (INT64_C(1) << 30) /* far outside of any image */
#define SPEED_LIMIT INT64_C(1000000) /* mm/s; faster ones saturate */
#define INTERVAL_MIN_US 1000
#define INTERVAL_MAX_US 10000000

/* pi / 180 to 2e-18 of itself. */
#define RADIAN_NUMERATOR INT64_C(21023143)
#define RADIAN_DENOMINATOR INT64_C(1204537366)

enum { TRACK_U0, TRACK_V0, TRACK_U1, TRACK_V1, TRACK_COLUMNS };
static const table_column_t track_columns[TRACK_COLUMNS] = {
    {"u0", 4, false}, {"v0", 4, false}, {"u1", 4, false}, {"v1", 4, false}};

enum { VEHICLE_FRAME, VEHICLE_TIME, VEHICLE_SPEED, VEHICLE_RATE, VEHICLE_COLUMNS };
static const table_column_t vehicle_columns[VEHICLE_COLUMNS] = {
    {"frame", 0, false}, {"time_s", 6, true}, {"speed_m_s", 3, true}, {"yaw_rate_deg_s", 6, true}};

static bool exists(const char *path) {
    struct stat status;

    return stat(path, &status) == 0;
}

/* The file of a frame in another folder: the frame's name with another ending. */
static bool sibling_path(char path[PATH_BYTES], const char *folder, const char *frame_name, const char *ending) {
    char name[PATH_BYTES];
    const int stem = (int)(strlen(frame_name) - strlen(".pgm"));
    const int length = snprintf(name, sizeof name, "%.*s%s", stem, frame_name, ending);

    if (length < 0 || (size_t)length >= sizeof name)
        return fault(frame_name, "the name is too long");
    return join_path(path, folder, name);
}

static bool has_every_image(const motion_t *motion, const recording_t *recording) {
    char path[PATH_BYTES];
    size_t index;

    for (index = 0; index < recording->count; index++)
        if (!sibling_path(path, motion->folder, recording->names[index], ".pgm") || !exists(path))
            return false;
    return true;
}

static bool find_source(motion_t *motion, const char *path, const recording_t *recording) {
    if (!join_path(motion->folder, path, "tracks"))
        return false;
    motion->source = exists(motion->folder) ? MOTION_TRACKS : MOTION_NONE;
    if (motion->source == MOTION_TRACKS)
        return true;
    if (!join_path(motion->folder, path, "left"))
        return false;
    if (exists(motion->folder) && has_every_image(motion, recording))
        motion->source = MOTION_IMAGES;
    return true;
}

static bool check_vehicle(const motion_t *motion) {
    const table_t *vehicle = &motion->vehicle;
    size_t row;

    for (row = 0; row < vehicle->rows; row++) {
        const int64_t frame = table_at(vehicle, row, VEHICLE_FRAME);

        if (frame < 0 || frame > UINT32_MAX)
            return fault(motion->vehicle_path, "row %zu: frame is outside 0...4294967295", row + 1);
        if (row > 0 && frame <= table_at(vehicle, row - 1, VEHICLE_FRAME))
            return fault(motion->vehicle_path, "row %zu: frame %lld does not rise", row + 1, (long long)frame);
    }
    return true;
}

static bool allocate(motion_t *motion, const rig_file_t *rig_file) {
    const size_t pixels = (size_t)rig_file->rig.width_px * rig_file->rig.height_px;
    unsigned i;

    motion->tracks = malloc(ROADPOSE_TRACKER_CELLS * sizeof *motion->tracks);
    for (i = 0; i < 2; i++) {
        motion->pixels[i] = malloc(pixels);
        motion->image[i] = (roadpose_grey_t){motion->pixels[i], rig_file->rig.width_px, rig_file->rig.width_px,
                                             rig_file->rig.height_px};
    }
    return (motion->tracks != NULL && motion->pixels[0] != NULL && motion->pixels[1] != NULL) ||
           fault(motion->folder, "is larger than memory");
}

bool motion_open(motion_t *motion, roadpose_heading_t *heading, const char *path, const recording_t *recording,
                 const rig_file_t *rig_file) {
    roadpose_result_t result;

    memset(motion, 0, sizeof *motion);
    motion->heading = heading;
    if (!join_path(motion->vehicle_path, path, "vehicle.csv") || !find_source(motion, path, recording))
        return false;
    if (motion->source == MOTION_NONE)
        return true;
    if (exists(motion->vehicle_path) &&
        (!table_read(&motion->vehicle, vehicle_columns, VEHICLE_COLUMNS, motion->vehicle_path) || !check_vehicle(motion)))
        return false;
    motion->interval_us = (int32_t)(MICRO * 1000 / rig_file->rate_millihz);
    motion->interval_us = motion->interval_us < INTERVAL_MIN_US ? INTERVAL_MIN_US : motion->interval_us;
    motion->interval_us = motion->interval_us > INTERVAL_MAX_US ? INTERVAL_MAX_US : motion->interval_us;
    result = roadpose_heading_init(motion->heading, &rig_file->rig, NULL);
    if (result == ROADPOSE_OK)
        result = roadpose_tracker_init(&motion->tracker, NULL);
    if (result != ROADPOSE_OK)
        return fault(path, "the yaw estimator refuses the rig (result %d)", (int)result);
    return allocate(motion, rig_file);
}

void motion_close(motion_t *motion) {
    table_free(&motion->vehicle);
    free(motion->tracks);
    free(motion->pixels[0]);
    free(motion->pixels[1]);
    motion->tracks = NULL;
    motion->pixels[0] = NULL;
    motion->pixels[1] = NULL;
}

static int64_t clamp(int64_t x, int64_t limit) {
    return x > limit ? limit : (x < -limit ? -limit : x);
}

/* 1/10000 px to 1/256 px, rounded half away from zero. */
static int32_t q8_of(int64_t scaled) {
    const int64_t x = clamp(scaled, Q8_LIMIT) * 256;

    return (int32_t)clamp((x + (x < 0 ? -5000 : 5000)) / 10000, Q8_LIMIT);
}

static bool read_tracks(motion_t *motion, const char *path) {
    table_t table;
    roadpose_track_t *tracks;
    size_t row;

    motion->count = 0;
    if (!exists(path)) /* the first frame has none, and a flow engine may lose one */
        return true;
    if (!table_read(&table, track_columns, TRACK_COLUMNS, path))
        return false;
    tracks = realloc(motion->tracks, (table.rows + 1) * sizeof *tracks);
    motion->tracks = tracks != NULL ? tracks : motion->tracks;
    for (row = 0; tracks != NULL && row < table.rows; row++)
        tracks[row] = (roadpose_track_t){
            q8_of(table_at(&table, row, TRACK_U0)), q8_of(table_at(&table, row, TRACK_V0)),
            q8_of(table_at(&table, row, TRACK_U1)), q8_of(table_at(&table, row, TRACK_V1))};
    motion->count = tracks != NULL ? table.rows : 0;
    table_free(&table);
    return tracks != NULL || fault(path, "is larger than memory");
}

static bool read_image(motion_t *motion, const char *path) {
    const roadpose_grey_t *previous = &motion->image[motion->present];

    motion->present = 1u - motion->present;
    motion->count = 0;
    if (!pgm_read_grey(motion->pixels[motion->present], previous->width_px, previous->height_px, path))
        return false;
    if (motion->has_previous)
        (void)roadpose_tracker_track(&motion->tracker, previous, &motion->image[motion->present], motion->tracks,
                                     ROADPOSE_TRACKER_CELLS, &motion->count);
    return true;
}

/* Row of a frame in vehicle.csv, or the number of rows. */
static size_t find_row(const table_t *vehicle, uint32_t frame) {
    size_t row = 0;

    while (row < vehicle->rows && table_at(vehicle, row, VEHICLE_FRAME) != (int64_t)frame)
        row++;
    return row;
}

/* Mean of a column over two rows; false where one is empty. */
static bool mean_of(const table_t *vehicle, size_t before, size_t now, size_t column, int64_t *mean) {
    const int64_t a = table_at(vehicle, before, column);
    const int64_t b = table_at(vehicle, now, column);

    *mean = (a == TABLE_EMPTY || b == TABLE_EMPTY) ? 0 : (a + b) / 2;
    return a != TABLE_EMPTY && b != TABLE_EMPTY;
}

static bool take_interval(motion_t *motion, size_t before, size_t now) {
    const int64_t begin = table_at(&motion->vehicle, before, VEHICLE_TIME);
    const int64_t end = table_at(&motion->vehicle, now, VEHICLE_TIME);

    if (begin == TABLE_EMPTY || end == TABLE_EMPTY)
        return true;
    if (end - begin < INTERVAL_MIN_US || end - begin > INTERVAL_MAX_US)
        return fault(motion->vehicle_path, "row %zu: time_s is not 0.001...10 s after that of the frame before",
                     now + 1);
    motion->motion.interval_us = (int32_t)(end - begin);
    return true;
}

/* What the vehicle did between the previous frame and this one. */
static bool take_vehicle(motion_t *motion, uint32_t frame) {
    const size_t before = find_row(&motion->vehicle, motion->previous_frame);
    const size_t now = find_row(&motion->vehicle, frame);
    int64_t speed, rate;

    motion->motion = (roadpose_motion_t){.interval_us = motion->interval_us};
    if (!motion->has_previous || before == motion->vehicle.rows || now == motion->vehicle.rows)
        return true;
    motion->motion.has_speed = mean_of(&motion->vehicle, before, now, VEHICLE_SPEED, &speed);
    motion->motion.has_yaw_rate = mean_of(&motion->vehicle, before, now, VEHICLE_RATE, &rate);
    motion->motion.speed_mm_s = (int32_t)clamp(speed, SPEED_LIMIT);
    motion->motion.yaw_rate_urad_s = (int32_t)(clamp(rate, 90 * MICRO) * RADIAN_NUMERATOR / RADIAN_DENOMINATOR);
    return take_interval(motion, before, now);
}

bool motion_read(motion_t *motion, const recording_t *recording, size_t index) {
    const uint32_t frame = recording_frame_number(recording, index);
    const bool is_image = motion->source == MOTION_IMAGES;
    char path[PATH_BYTES];
    bool is_read;

    if (motion->source == MOTION_NONE)
        return true;
    is_read = sibling_path(path, motion->folder, recording->names[index], is_image ? ".pgm" : ".csv") &&
              (is_image ? read_image(motion, path) : read_tracks(motion, path)) && take_vehicle(motion, frame);
    motion->has_previous = true;
    motion->previous_frame = frame;
    return is_read;
}

bool motion_estimate(motion_t *motion, const roadpose_pose_t *pose) {
    const int32_t *normal_q30 = pose->status == ROADPOSE_STATUS_OK ? pose->normal_q30 : NULL;

    if (motion->source == MOTION_NONE)
        return false;
    return roadpose_heading_process(motion->heading, motion->tracks, motion->count, &motion->motion, normal_q30,
                                    &motion->yaw) == ROADPOSE_OK &&
           roadpose_heading_running(motion->heading, &motion->running) == ROADPOSE_OK;
}
