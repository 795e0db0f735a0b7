/* Simulated drives: tracks of a car on a flat street with walls, other road users and false matches, and what is true.
 * Everything in double precision. Vehicle axes X forward, Y left, Z up; angles in radians. */
#ifndef ROADPOSE_TEST_DRIVE_SIMULATION_H
#define ROADPOSE_TEST_DRIVE_SIMULATION_H

#include <stdbool.h>

#include "random_numbers.h"
#include "roadpose/rig.h"
#include "roadpose/track.h"

#ifdef __cplusplus
extern "C" {
#endif

#define SIMULATION_TRACKS_MAX 600

typedef struct {
    double width, height, focal_px, cu_px, cv_px, baseline_m;
} simulated_rig_t;

typedef struct {
    double pitch, roll, yaw; /* ISO 8855, as in the library */
    double height_m;
} simulated_mount_t;

typedef struct {
    double moved_m;       /* along the arc between the two frames */
    double turn;          /* change of heading between them, + = to the left */
    double noise_px;      /* of each coordinate of each end of a track */
    double outlier_share; /* half of them false matches, half on things that move by themselves */
    int tracks;
} simulated_step_t;

typedef struct {
    double u0, v0, u1, v1; /* relative to the principal point, pixels */
    bool still;            /* a true match on something that stands still */
} simulated_track_t;

typedef struct {
    int count;
    simulated_track_t track[SIMULATION_TRACKS_MAX];
} simulated_tracks_t;

extern const simulated_rig_t SIMULATED_RIG; /* 640 x 480, f = 500 px, B = 0.30 m */

void simulate_tracks(simulated_tracks_t *tracks, const simulated_rig_t *rig, const simulated_mount_t *mount,
                     const simulated_step_t *step, random_numbers_t *random);

/* Unit normal of the road in camera axes, pointing into the road. */
void mount_normal(const simulated_mount_t *mount, double normal[3]);
void mount_normal_q30(const simulated_mount_t *mount, int32_t normal_q30[3]);

/* Image of the direction of straight travel, relative to the principal point. */
void mount_focus(const simulated_mount_t *mount, double focal_px, double focus[2]);

/* Yaw of a focus of expansion, as GEOMETRY: forward = t - (t n) n, left = -n x t. */
double yaw_of_focus(const double focus[2], double focal_px, const double normal[3]);

/* The reference: least squares of the distance of the focus from the lines of the still tracks, each weighed by
 * 1 / (r / L)^2 (the noise is the same for all). Starts from the true focus. */
void reference_focus(const simulated_tracks_t *tracks, const double true_focus[2], double focus[2]);

void library_tracks(const simulated_tracks_t *tracks, const simulated_rig_t *rig, roadpose_track_t *out);
roadpose_rig_t library_rig(const simulated_rig_t *rig);

static inline double degrees_of(double radians) { return radians * 57.295779513082320877; }
static inline double radians_of(double degrees) { return degrees / 57.295779513082320877; }

#ifdef __cplusplus
}
#endif

#endif
