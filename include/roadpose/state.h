/* roadpose: the memory of one instance. Public so that the caller can place it (static, stack, any section); its
 * members are private: nothing outside the library reads or writes them. */
#ifndef ROADPOSE_STATE_H
#define ROADPOSE_STATE_H

#include <stdbool.h>
#include <stdint.h>

#include "roadpose/disparity.h"
#include "roadpose/limits.h"
#include "roadpose/pose.h"
#include "roadpose/rig.h"

/* How to read one sample, prepared from the format once. All masks are in place within the sample. */
typedef struct {
    bool swap_bytes;          /* the samples' byte order is not the processor's */
    bool is_plain;            /* a disparity is what lies in one range of samples, whose bits all count */
    uint16_t value_mask;      /* disparity field */
    uint32_t value_scale;     /* (s & value_mask) * value_scale / 256 is the disparity in Q8 */
    uint32_t plain_first;     /* plain: no match where s - plain_first > plain_span, unsigned */
    uint32_t plain_span;
    uint16_t sign_mask;       /* no match where it is set */
    uint16_t invalid_first;
    int32_t invalid_span;     /* no match where (uint16_t)(s - invalid_first) <= invalid_span; -1: never */
    uint16_t confidence_mask; /* confidence field */
    uint16_t confidence_min;  /* no match where (s & confidence_mask) < confidence_min; 0: never */
    uint16_t image_confidence_min; /* the same for a sample of the confidence image */
    int32_t offset_q8;
} roadpose_decoder_t;

/* The rig on the sampling grid. Grid column i is pixel column i * COLUMN_STEP, grid row j pixel row j * ROW_STEP;
 * x = i - column_0 and y = j - row_0 count from the grid point next to the principal point. */
typedef struct {
    int16_t columns;
    int16_t rows;
    int16_t column_0;
    int16_t row_0;
    int32_t du_millipx; /* pixel column of column_0 minus cu */
    int32_t dv_millipx; /* pixel row of row_0 minus cv */
    int32_t focal_millipx;
    int32_t baseline_um;
} roadpose_grid_t;

/* Disparity plane on the grid: d = a x + b y + c, pixels. */
typedef struct {
    int32_t a_q24;
    int32_t b_q24;
    int64_t c_q24;
} roadpose_plane_t;

typedef struct {
    roadpose_count_t count[ROADPOSE_MAX_GRID_COLUMNS][ROADPOSE_MAX_DISPARITY];
} roadpose_u_disparity_t;

typedef struct {
    roadpose_count_t count[ROADPOSE_MAX_GRID_ROWS][ROADPOSE_MAX_DISPARITY];
} roadpose_v_disparity_t;

/* One bit for each cell of the u-disparity: free of obstacles, and within the widened corridor. */
typedef struct {
    uint32_t bits[ROADPOSE_MAX_GRID_COLUMNS][ROADPOSE_MAX_DISPARITY / 32];
} roadpose_free_map_t;

/* Samples of the free map in row order. */
typedef struct {
    uint16_t count;
    uint16_t row_start[ROADPOSE_MAX_GRID_ROWS + 1]; /* points of row j: row_start[j]...row_start[j + 1] - 1 */
    uint16_t column[ROADPOSE_MAX_POINTS];           /* grid column; in the two high bits the corridor's weight */
    uint16_t disparity_q8[ROADPOSE_MAX_POINTS];
} roadpose_points_t;

/* Spreads `keep` choices evenly over `total` candidates. */
typedef struct {
    uint32_t keep;
    uint32_t total;
    uint32_t error;
} roadpose_thinning_t;

#define ROADPOSE_SORT_LEVELS (ROADPOSE_MAX_DISPARITY * 8) /* an eighth of a pixel each */

/* Method 2, stage 1: pairs of points of one disparity level. */
typedef struct {
    uint16_t order[ROADPOSE_MAX_POINTS];      /* points used, by rising disparity */
    uint16_t bucket[ROADPOSE_SORT_LEVELS + 1];
    uint16_t used;                            /* entries of order */
    uint8_t first_octave;                     /* of the sort levels in use: level 2^k...2^(k+1) - 1 is octave k */
    uint8_t last_octave;
    uint16_t pairs;
    int16_t dx[ROADPOSE_MAX_PAIRS];           /* grid columns from the first to the second point */
    int16_t dy[ROADPOSE_MAX_PAIRS];           /* grid rows */
    int16_t x_sum[ROADPOSE_MAX_PAIRS];        /* x of both added */
    int16_t y_sum[ROADPOSE_MAX_PAIRS];
    uint16_t level_q8[ROADPOSE_MAX_PAIRS];    /* mean disparity */
    int32_t intercept_q9[ROADPOSE_MAX_PAIRS]; /* y - s x of the pair's middle, 2^-9 grid rows, once s is known */
} roadpose_cloud_t;

/* Box around the mounting limits in terms of the plane, for quick rejection of candidates: a little wider than the
 * limits, which the finished pose is held against. */
typedef struct {
    int32_t b_min_q24; /* disparity per grid row */
    int32_t b_max_q24;
    int64_t c_min_rows_q16; /* c / b: grid rows from the horizon to the principal point */
    int64_t c_max_rows_q16;
    int32_t slope_max_q16; /* |a / b|, grid rows per grid column */
} roadpose_plane_box_t;

/* Which points count around the present plane. */
typedef struct {
    int32_t a_q18;           /* the plane's change from one grid column to the next */
    int32_t range_min_q8;    /* the plane's disparity must be at least this */
    int32_t du_q12;          /* pixel column of grid column_0 minus cu */
    int32_t centre_q12;      /* corridor: lateral position of its middle, in baselines */
    uint32_t half_outer_q12; /* half width in baselines where points still count half */
    uint32_t half_inner_q12; /* and where they count full */
    int32_t noise_q8;        /* half width of the band that noise needs, pixels */
    uint32_t unevenness_q16; /* what an uneven road adds to it, as a share of the disparity */
    bool mark_corridor;      /* weigh the points by the corridor anew; else take their last weights */
} roadpose_road_rule_t;

/* What lies near the plane at one distance, that is, where the plane's disparity has this whole part. */
typedef struct {
    bool open;        /* the points at this distance take part in the least squares */
    bool uneven;      /* and of those too that noise alone does not explain */
    int16_t band_q8;  /* half width of the band in which they do; -1: closed */
    uint16_t on;      /* points within the noise band around the plane, */
    uint16_t off;     /* points beyond it, within 4 px, */
    int32_t r;        /* and the sum of the residuals of those within, Q8 */
} roadpose_level_t;

/* Sums of a least-squares step over the road points, and what the acceptance needs. */
typedef struct {
    int64_t n, x, y, xx, xy, yy, r, xr, yr, rr; /* weights, grid steps and residuals in Q8 pixels */
    uint32_t on_road; /* points that take part */
    uint32_t uneven;  /* near the plane, but at a distance that is closed */
    uint32_t above;   /* nearer to the camera than the plane */
    uint32_t below;   /* farther than the plane, which should hide them */
    roadpose_level_t level[ROADPOSE_MAX_DISPARITY];
} roadpose_moments_t;

typedef struct {
    uint32_t ready; /* a mark, once initialised */
    roadpose_settings_t settings;
    roadpose_grid_t grid;
    roadpose_decoder_t decoder;
    roadpose_plane_box_t box;
    uint16_t width_px;
    uint16_t height_px;
    bool has_confidence_image;
    roadpose_frame_t frame;
    roadpose_pose_t pose; /* of the last finished frame */
    uint8_t phase;
    uint8_t round;      /* of a phase that repeats */
    uint16_t cursor;    /* next row, column, point or hypothesis of the phase */
    uint32_t random;    /* state of the linear congruential generator */
    roadpose_thinning_t thinning; /* of the points of the running phase */
    int32_t best_score;
    int32_t slope_q16;  /* Method 2: grid rows per grid column along a disparity level */
    bool roll_observed;
    roadpose_plane_t plane;
    roadpose_plane_t noise_plane; /* before the rounds that follow the uneven road */
    roadpose_road_rule_t rule;    /* of the running look */
    roadpose_moments_t moments;
    uint16_t row_q8[ROADPOSE_MAX_GRID_COLUMNS]; /* one decoded row */
    roadpose_free_map_t free_map;
    roadpose_v_disparity_t v_disparity;
    roadpose_points_t points;
    union {
        roadpose_u_disparity_t u_disparity; /* until the free map is made */
        roadpose_cloud_t cloud;             /* from then on */
    } work;
} roadpose_t;

#endif
