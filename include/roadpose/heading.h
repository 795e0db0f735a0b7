/* roadpose: yaw of the rig from motion, the mount angle that a road plane cannot show.
 *
 * When the car drives straight, points that stand still stream away from the focus of expansion, the image of the
 * direction of travel (the paper, section 3.2). From tracks (the same points in two frames): intersections of track lines,
 * RANSAC, then a robust fit that weighs each track by 1 / (sigma sqrt(2) r / L)^2 (r its distance from the focus, L its
 * length). The fit asks each time whether a rotation of the camera between the frames explains the tracks better: a turn, and
 * any pitching of the car, shows as a rotation that the tracks insist on. docs/heading.md tells the method and what it reaches.
 *
 * Use: one roadpose_heading_t for each camera, in memory that the caller owns; roadpose_heading_init() once;
 * roadpose_heading_process() for each pair of frames, with the road normal of the pose (roadpose_pose_t.normal_q30);
 * roadpose_heading_running() whenever the estimate over the drive is wanted.
 *
 * Axes, signs and units as in roadpose.h; yaw + = the camera looks to the left of the direction of travel.
 * Every function is re-entrant: no global state, no heap, no floating point, no clock. Two instances are independent;
 * one instance must not be used from two threads at the same time. The same calls give the same bits on every machine. */
#ifndef ROADPOSE_HEADING_H
#define ROADPOSE_HEADING_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "roadpose/roadpose.h"
#include "roadpose/track.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Tracks of one frame pair that are used; of more than that, evenly spread ones are dropped and counted. */
#ifndef ROADPOSE_MAX_TRACKS
#define ROADPOSE_MAX_TRACKS 256
#endif
/* Frames that the running yaw remembers. */
#ifndef ROADPOSE_YAW_HISTORY
#define ROADPOSE_YAW_HISTORY 64
#endif
#if ROADPOSE_MAX_TRACKS < 32 || ROADPOSE_MAX_TRACKS > 512
#error "roadpose: set ROADPOSE_MAX_TRACKS to 32...512: the sums of the fit are proved up to 512 tracks"
#endif
#if ROADPOSE_YAW_HISTORY < 8 || ROADPOSE_YAW_HISTORY > 256
#error "roadpose: set ROADPOSE_YAW_HISTORY to 8...256: the running yaw sorts that many values after each frame"
#endif

/* Tracks that vote on each hypothesis of the search: evenly spread ones of those that move. */
#define ROADPOSE_MAX_VOTERS 64

/* What the vehicle says about its motion between the two frames. */
typedef struct {
    int32_t interval_us;       /* time between the two frames, 1000...10 000 000 */
    bool has_speed;            /* speed_mm_s is given */
    bool has_yaw_rate;         /* yaw_rate_urad_s is given */
    int32_t speed_mm_s;        /* + = forward; any value */
    int32_t yaw_rate_urad_s;   /* + = to the left; any value */
} roadpose_motion_t;

/* Settings. Take roadpose_heading_settings_default() and change what you must: a zeroed struct is refused. */
typedef struct {
    uint32_t seed;                 /* of the linear congruential generator; each frame starts from it. Default 1 */
    uint16_t tracks_min;           /* fewest moving tracks that agree, 8...ROADPOSE_MAX_TRACKS. Default 12 */
    uint16_t share_min_permille;   /* smallest share of the used tracks that agree, 100...1000. Default 350 */
    int32_t moving_min_millipx;    /* a track this long moves, 500...20 000. Default 2000 */
    int32_t noise_max_millipx;     /* largest spread across the direction of flow, 100...5000. Default 1000 */
    int32_t speed_min_mm_s;        /* where speed is given: no yaw below it, 0...50 000. Default 3000 */
    int32_t yaw_rate_max_urad_s;   /* no yaw in sharper turns, by the vehicle or by the tracks (rate and three deviations),
                                      1000...1 000 000. Default 61 087 (3.5 deg/s) */
    int32_t rate_sigma_max_urad_s; /* where the vehicle gives no yaw rate: how well the tracks must tell it, 1000...
                                      1 000 000. Default 13 090 (0.75 deg/s) */
    int32_t sigma_max_urad;        /* largest standard deviation of a frame's yaw, 100...100 000. Default 4363 (0.25 deg).
                                      Where the vehicle gives no yaw rate, twice as much is allowed to the yaw that the
                                      tracks tell without assuming straight travel */
    int32_t yaw_max_urad;          /* mounting limit to either side, 0...400 000. Default 104 720 (6 deg) */
} roadpose_heading_settings_t;

/* May I trust this frame's yaw, and if not, why was it refused? The first reason that applies: what the vehicle says,
 * then the number of tracks, then what they show. */
typedef enum {
    ROADPOSE_YAW_OK = 0,
    ROADPOSE_YAW_SLOW = 1,           /* the vehicle's speed is below speed_min_mm_s, or it drives backwards */
    ROADPOSE_YAW_TURNING = 2,        /* the vehicle's yaw rate, or the tracks, show a turn */
    ROADPOSE_YAW_FEW_TRACKS = 3,     /* fewer than tracks_min tracks within the image */
    ROADPOSE_YAW_STANDING = 4,       /* too few tracks move: under a fifth, or, where no speed is given, under a quarter
                                        of all move and agree */
    ROADPOSE_YAW_NO_FOCUS = 5,       /* no single focus explains the tracks: too few agree with the best one */
    ROADPOSE_YAW_NOISY = 6,          /* they agree, but within more than noise_max_millipx */
    ROADPOSE_YAW_AMBIGUOUS = 7,      /* these tracks cannot tell a turn from straight travel, and nothing else does: the yaw
                                        rate is too uncertain, a turn explains them about as well, they show one that too few
                                        of them share, or they scatter by more than 90 % of noise_max_millipx */
    ROADPOSE_YAW_UNCERTAIN = 8,      /* the standard deviation exceeds sigma_max_urad */
    ROADPOSE_YAW_NO_ROAD = 9,        /* no road normal was given: a focus, but no yaw */
    ROADPOSE_YAW_OUTSIDE_LIMITS = 10 /* yaw exceeds yaw_max_urad */
} roadpose_yaw_status_t;
#define ROADPOSE_YAW_STATUS_COUNT 11

/* Yaw from one pair of frames. Where status is not ROADPOSE_YAW_OK, yaw, the pitch figures and sigma are 0 and mean
 * nothing; the figures of the tracks are filled as far as the work came. */
typedef struct {
    uint8_t status;                /* roadpose_yaw_status_t */
    int32_t yaw_urad;              /* + = camera looks to the left of the direction of travel */
    int32_t sigma_urad;            /* its standard deviation, from the tracks' spread */
    int32_t pitch_motion_urad;     /* second opinion on pitch: of the camera against the direction of travel */
    int32_t pitch_difference_urad; /* pitch of the road plane minus pitch of motion: shows a matcher's disparity offset */
    int32_t focus_u_q8;            /* focus of expansion in the image, 1/256 px; may lie outside it */
    int32_t focus_v_q8;
    int32_t yaw_rate_urad_s;       /* the camera's yaw rate as the tracks tell it, + = to the left */
    int32_t yaw_rate_sigma_urad_s; /* its standard deviation; tells how far the tracks can tell a turn */
    uint16_t tracks_used;          /* tracks within the image, at most ROADPOSE_MAX_TRACKS */
    uint16_t tracks_moving;        /* of those, the ones that move */
    uint16_t tracks_agreeing;      /* of the moving ones, those that stream away from the focus */
    uint16_t noise_millipx;        /* standard deviation across the direction of flow, of both ends of a track together */
    uint32_t dropped_outside;      /* tracks not used: a point outside the image or too far from the axis (63 deg), or a
                                      jump of more than half the focal length */
    uint32_t dropped_limit;        /* tracks not used: more than ROADPOSE_MAX_TRACKS */
} roadpose_yaw_t;

/* Yaw over the drive: a robust weighted mean of the frames' yaws, and, where a rotation too small for a single frame is
 * common to all of them, what it changes. count 0: there is none yet, the other fields are 0. */
typedef struct {
    int32_t yaw_urad;     /* of the remembered frames */
    int32_t spread_urad;  /* robust standard deviation of one frame about it */
    uint16_t count;       /* frames in it, at most ROADPOSE_YAW_HISTORY */
    uint32_t accepted;    /* frames accepted since init or restart */
    uint32_t refused[ROADPOSE_YAW_STATUS_COUNT]; /* frames refused since then, by status */
} roadpose_running_yaw_t;

/* Private from here on: members of the instance. Angles of the pin-hole model, x = (u - cu) / f; 1 = 45 degrees. */
typedef struct {
    int32_t mx_q16; /* middle of the track */
    int32_t my_q16;
    int32_t dx_q22; /* from its previous to its present end */
    int32_t dy_q22;
} roadpose_flow_t;

typedef struct {
    int32_t k_q20;     /* 1/256 px -> q24 angle */
    int32_t px_q22;    /* one pixel as an angle */
    int32_t cu_q8;
    int32_t cv_q8;
    int32_t u_low_q8;  /* columns and rows of the image that are not too far from the axis: first, number less one */
    int32_t u_span_q8;
    int32_t v_low_q8;
    int32_t v_span_q8;
    int32_t jump_q8;   /* longest step of a track along an axis */
    int32_t focal_millipx;
} roadpose_lens_t;

typedef struct {
    int16_t mx_q12[ROADPOSE_MAX_VOTERS];
    int16_t my_q12[ROADPOSE_MAX_VOTERS];
    int16_t dx_q15[ROADPOSE_MAX_VOTERS]; /* flow without the vehicle's rotation */
    int16_t dy_q15[ROADPOSE_MAX_VOTERS];
    int16_t turn_u_q18[ROADPOSE_MAX_VOTERS]; /* what one step of the search for a turn adds to it */
    int16_t turn_v_q18[ROADPOSE_MAX_VOTERS];
    uint16_t count;
} roadpose_voters_t;

#define ROADPOSE_MAX_HYPOTHESES 80

/* A focus of expansion and a rotation, and how many points the voters gave it. */
typedef struct {
    int16_t fx_q12;
    int16_t fy_q12;
    int16_t steps;
    uint16_t points;
} roadpose_hypothesis_t;

/* Normal equations of up to five unknowns, and their factors. */
typedef struct {
    int64_t h[15]; /* lower triangle, row by row: weight j j, q40 */
    int64_t g[5];  /* weight j e, q46 */
} roadpose_sums_t;

typedef struct {
    uint32_t unknowns;
    uint32_t half_shift; /* d, l and z are scaled down by 2^(2 half_shift) */
    int64_t d[5];
    int64_t l[5][5];     /* below the diagonal, q20 */
    int64_t z[5];
} roadpose_factors_t;

#define ROADPOSE_NOISE_BINS 64

/* One round of a fit. */
typedef struct {
    roadpose_sums_t sums;
    roadpose_factors_t factors;
    uint16_t bins[ROADPOSE_NOISE_BINS];
    int32_t noise_q22;
    int32_t cost_q8;   /* of all flows looked at */
    uint16_t agreeing; /* moving flows within three deviations that stream away from the focus */
} roadpose_round_t;

typedef struct {
    uint32_t ready;
    roadpose_heading_settings_t settings;
    roadpose_lens_t lens;
    roadpose_flow_t flow[ROADPOSE_MAX_TRACKS];
    uint16_t flows;
    uint16_t flows_moving; /* the first ones */
    roadpose_voters_t voters;
    roadpose_hypothesis_t hypothesis[ROADPOSE_MAX_HYPOTHESES];
    roadpose_round_t round;
    int32_t history_urad[ROADPOSE_YAW_HISTORY];
    int32_t history_sigma_urad[ROADPOSE_YAW_HISTORY];
    int16_t history_free_urad[ROADPOSE_YAW_HISTORY];
    int32_t sorted_urad[ROADPOSE_YAW_HISTORY];
    int32_t free_urad; /* what a free rotation would add to this frame's yaw */
    uint16_t history_next;
    roadpose_running_yaw_t running;
} roadpose_heading_t;

/* Fills *settings with the defaults above. Does nothing on NULL. Constant time. */
void roadpose_heading_settings_default(roadpose_heading_settings_t *settings);

/* Checks rig and settings and makes *instance ready, with no history; copies what it needs. Of the rig only the image
 * size, focal length and principal point count. settings may be NULL: the defaults. instance: caller's memory of
 * sizeof(roadpose_heading_t) bytes, any content. Returns ROADPOSE_OK, or ROADPOSE_ERROR_NULL, _RIG, _SIZE (rig larger
 * than the limits), _SETTINGS with *instance unchanged. Constant time. */
roadpose_result_t roadpose_heading_init(roadpose_heading_t *instance, const roadpose_rig_t *rig,
                                        const roadpose_heading_settings_t *settings);

/* Yaw of one pair of frames; an accepted one joins the running yaw.
 * tracks: count tracks, borrowed for the call; may be NULL when count is 0. motion: what the vehicle says; NULL: nothing,
 * and the frames are taken as 100 ms apart. normal_q30: three numbers, unit normal of the road in camera axes as in
 * roadpose_pose_t; NULL: not known in this frame. *yaw is written only on ROADPOSE_OK.
 * Returns ROADPOSE_OK, ROADPOSE_ERROR_NULL, _ORDER (not initialised), or _SETTINGS (interval out of range, or the
 * normal is not of unit length within 1 %). Cost: at most two passes over all tracks; 40 hypotheses, 80 more where the vehicle
 * gives no yaw rate, of which a third are heard by 24 of ROADPOSE_MAX_VOTERS tracks and a tenth by all; six coarse passes,
 * over a third of ROADPOSE_MAX_TRACKS tracks, and six over all. */
roadpose_result_t roadpose_heading_process(roadpose_heading_t *instance, const roadpose_track_t *tracks, size_t count,
                                           const roadpose_motion_t *motion, const int32_t *normal_q30,
                                           roadpose_yaw_t *yaw);

/* The estimate over the drive so far. Returns ROADPOSE_OK, ROADPOSE_ERROR_NULL or ROADPOSE_ERROR_ORDER (not
 * initialised). Constant time. */
roadpose_result_t roadpose_heading_running(const roadpose_heading_t *instance, roadpose_running_yaw_t *running);

/* Forgets the history, as after a remount. Returns as roadpose_heading_running(). Constant time. */
roadpose_result_t roadpose_heading_restart(roadpose_heading_t *instance);

/* sizeof(roadpose_heading_t) of the built library: compare it with the caller's to find headers compiled with other
 * limits. */
size_t roadpose_heading_state_bytes(void);

/* A word for a status: "ok", "slow", "turning", "few_tracks", "standing", "no_focus", "noisy", "ambiguous",
 * "uncertain", "no_road", "outside_limits"; "unknown" for anything else. Never NULL; static storage. */
const char *roadpose_yaw_status_word(uint8_t status);

#ifdef __cplusplus
}
#endif

#endif
