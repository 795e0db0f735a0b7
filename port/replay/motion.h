/* Yaw from a recording's motion: tracks/ or, where there are none, our own tracker on left/; and vehicle.csv. */
#ifndef REPLAY_MOTION_H
#define REPLAY_MOTION_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "recording.h"
#include "rig_file.h"
#include "roadpose/heading.h"
#include "roadpose/tracker.h"
#include "table.h"

typedef enum { MOTION_NONE, MOTION_TRACKS, MOTION_IMAGES } motion_source_t;

typedef struct {
    motion_source_t source;
    char folder[PATH_BYTES]; /* tracks/ or left/ */
    char vehicle_path[PATH_BYTES];
    table_t vehicle;         /* no rows: there is no vehicle.csv */
    int32_t interval_us;     /* of frames without a time */
    bool has_previous;       /* a frame before this one */
    uint32_t previous_frame; /* its number */
    roadpose_motion_t motion;
    roadpose_heading_t *heading; /* the caller's */
    roadpose_tracker_t tracker;
    roadpose_grey_t image[2]; /* this frame's and the previous one's, in turn */
    uint8_t *pixels[2];
    unsigned present;         /* index of this frame's image */
    roadpose_track_t *tracks;
    size_t count;
    roadpose_yaw_t yaw; /* of the last frame */
    roadpose_running_yaw_t running;
} motion_t;

/* Looks for what the recording has. *heading is the caller's, must live on, and is made ready here. Reports a fault and
 * returns false when the recording cannot be used. Close it in either case. */
bool motion_open(motion_t *motion, roadpose_heading_t *heading, const char *path, const recording_t *recording,
                 const rig_file_t *rig_file);
void motion_close(motion_t *motion);

/* Reads what belongs to a frame. Reports a fault and returns false. */
bool motion_read(motion_t *motion, const recording_t *recording, size_t index);

/* Yaw of the frame that was read, into motion->yaw and motion->running; false when the recording has no motion. */
bool motion_estimate(motion_t *motion, const roadpose_pose_t *pose);

#endif
