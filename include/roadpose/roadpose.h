/* roadpose: pitch, roll and height of a stereo rig over the road, from its disparity maps.
 *
 * Method: Musleh, Martin, Armingol, de la Escalera, "Pose Self-Calibration of Stereo Vision Systems for Autonomous
 * Vehicle Applications", Sensors 2016, 16, 1492 (called "the paper"), followed by a least-squares refinement in
 * disparity space. docs/design.md tells the method and where it departs from the paper.
 *
 * Axes. Camera (left, rectified): x right, y down, z forward. Vehicle (ISO 8855): X forward, Y left, Z up.
 *   pitch + = nose down, roll + = right side down, height > 0 = left camera's centre over the road plane.
 * Units are in the names: urad = 1e-6 rad, um = 1e-6 m, millipx = 1e-3 pixel, q24 = value * 2^24.
 *
 * Use: one roadpose_t for each camera, in memory that the caller owns; roadpose_init() once; for each frame either
 * roadpose_process(), or roadpose_frame_begin(), roadpose_frame_slice() until it says ROADPOSE_OK, and
 * roadpose_frame_pose(). Three answers are kept apart: roadpose_result_t says whether the call was right,
 * roadpose_status_t whether this frame gave a pose and why not, and the support figures how good it is.
 *
 * Every function is re-entrant: no global state, no heap, no floating point, no clock. Two instances are independent;
 * one instance must not be used from two threads at the same time. The same samples, rig, format, settings and limits
 * give the same bits on every machine: a frame's result does not depend on the frames before it.
 */
#ifndef ROADPOSE_ROADPOSE_H
#define ROADPOSE_ROADPOSE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "roadpose/disparity.h"
#include "roadpose/limits.h"
#include "roadpose/pose.h"
#include "roadpose/rig.h"
#include "roadpose/state.h"

#ifdef __cplusplus
extern "C" {
#endif

#define ROADPOSE_VERSION_MAJOR 0
#define ROADPOSE_VERSION_MINOR 1
#define ROADPOSE_VERSION_PATCH 0

/* Was the call right? On every negative code the instance and all outputs are unchanged. */
typedef enum {
    ROADPOSE_OK = 0,
    ROADPOSE_MORE = 1,            /* the frame is not finished: call roadpose_frame_slice() again */
    ROADPOSE_ERROR_NULL = -1,     /* a pointer that must be given is NULL */
    ROADPOSE_ERROR_SIZE = -2,     /* frame size differs from the rig's, or the rig's exceeds the compile-time limits */
    ROADPOSE_ERROR_STRIDE = -3,   /* stride_bytes is smaller than a row */
    ROADPOSE_ERROR_FORMAT = -4,   /* a field of the disparity format is out of range */
    ROADPOSE_ERROR_RIG = -5,      /* a field of the rig is out of range */
    ROADPOSE_ERROR_SETTINGS = -6, /* a setting is out of range */
    ROADPOSE_ERROR_ORDER = -7     /* not initialised, no frame begun, a frame still running, or no pose yet */
} roadpose_result_t;

/* Fills *settings with the defaults below. Does nothing on NULL. Constant time. */
void roadpose_settings_default(roadpose_settings_t *settings);

/* Checks rig, format and settings and makes *instance ready; copies all three. settings may be NULL: the defaults.
 * instance: caller's memory of sizeof(roadpose_t) bytes, any content. Returns ROADPOSE_OK, or ROADPOSE_ERROR_NULL,
 * _RIG, _SIZE (rig larger than the limits), _FORMAT, _SETTINGS with *instance unchanged. Cost: constant. */
roadpose_result_t roadpose_init(roadpose_t *instance, const roadpose_rig_t *rig,
                                const roadpose_disparity_format_t *format, const roadpose_settings_t *settings);

/* Begins a frame. *frame is copied; its buffers are borrowed until the frame is finished or cancelled.
 * Returns ROADPOSE_OK, or ROADPOSE_ERROR_NULL, _ORDER (not initialised, or a frame is running), _SIZE, _STRIDE.
 * Constant time: the histograms are cleared in the first slices. */
roadpose_result_t roadpose_frame_begin(roadpose_t *instance, const roadpose_frame_t *frame);

/* Does one slice of the frame's work. Returns ROADPOSE_MORE while work is left, ROADPOSE_OK when this slice finished
 * the frame, ROADPOSE_ERROR_NULL, or ROADPOSE_ERROR_ORDER when no frame is running.
 * Cost of one slice: at most ROADPOSE_SLICE_SAMPLES samples decoded or points visited, or one RANSAC hypothesis, which is
 * a fraction of that (docs/budgets.md has instructions); the number of slices of a frame is at most roadpose_slices_max(). */
roadpose_result_t roadpose_frame_slice(roadpose_t *instance);

/* Gives the pose of the last finished frame; *pose is the caller's. Returns ROADPOSE_OK, ROADPOSE_ERROR_NULL, or
 * ROADPOSE_ERROR_ORDER when no frame was finished since init, begin or cancel. Constant time. */
roadpose_result_t roadpose_frame_pose(const roadpose_t *instance, roadpose_pose_t *pose);

/* Gives up the running frame, if any, and lets go of its buffers. Returns ROADPOSE_OK, ROADPOSE_ERROR_NULL or
 * ROADPOSE_ERROR_ORDER (not initialised). Constant time. */
roadpose_result_t roadpose_frame_cancel(roadpose_t *instance);

/* The whole frame in one call: begin, all slices, pose. Same bits as the slices. *pose is written only on ROADPOSE_OK.
 * Reads each sample of the grid at most twice. */
roadpose_result_t roadpose_process(roadpose_t *instance, const roadpose_frame_t *frame, roadpose_pose_t *pose);

/* Upper bound of the slices of one frame with the compile-time limits. Constant time. */
uint32_t roadpose_slices_max(void);

/* sizeof(roadpose_t) of the built library: compare it with the caller's to find headers compiled with other limits. */
size_t roadpose_state_bytes(void);
#define ROADPOSE_STATE_BYTES sizeof(roadpose_t)

/* A word for a status, for logs and CSV: "ok", "no_disparity", "no_road", "little_support", "short_range", "poor_fit",
 * "outside_limits"; "unknown" for anything else. Never NULL; static storage. */
const char *roadpose_status_word(uint8_t status);

/* For viewers and tests: the histograms and the map of the last finished frame, on the sampling grid (one column for
 * every ROADPOSE_COLUMN_STEP pixels, one row for every ROADPOSE_ROW_STEP). Outside the grid, or before the pass that
 * fills them, they answer 0 and false. Constant time. */
bool roadpose_is_free(const roadpose_t *instance, uint16_t grid_column, uint16_t disparity_px);
uint16_t roadpose_v_disparity_free(const roadpose_t *instance, uint16_t grid_row, uint16_t disparity_px);

#ifdef __cplusplus
}
#endif

#endif
