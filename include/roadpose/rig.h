/* roadpose: the stereo rig, and the settings of the estimator. */
#ifndef ROADPOSE_RIG_H
#define ROADPOSE_RIG_H

#include <stdbool.h>
#include <stdint.h>

/* Rectified stereo rig. The left camera is the reference. */
typedef struct {
    uint16_t width_px;     /* 64...ROADPOSE_MAX_WIDTH */
    uint16_t height_px;    /* 64...ROADPOSE_MAX_HEIGHT */
    int32_t focal_millipx; /* focal length, 50 000...4 000 000 (50...4000 px) */
    int32_t cu_millipx;    /* principal point, column: 0...1000 * (width_px - 1) */
    int32_t cv_millipx;    /* principal point, row: 0...1000 * (height_px - 1) */
    int32_t baseline_um;   /* 20 000...2 000 000 (2 cm...2 m) */
} roadpose_rig_t;

/* Settings. Take roadpose_settings_default() and change what you must: a zeroed struct is refused. */
typedef struct {
    uint8_t method;                 /* 1: road profile in the v-disparity-free, roll taken as zero (paper, 3.1.1);
                                       2: ground plane from the cloud of slopes and intercepts (paper, 3.1.2). Default 2 */
    bool refine;                    /* least squares on the road points after the method. Default true */
    uint8_t points_percent;         /* share of the free map's points that Method 2 pairs, 1...100. Default 100 */
    uint32_t seed;                  /* of the linear congruential generator; each frame starts from it. Default 1 */
    int32_t corridor_half_width_mm; /* road further sideways does not count; 0: no limit; 500...100 000. Default 2000.
                                       The edge is soft: half weight from 7/8 to 9/8 of it */
    int32_t corridor_range_mm;      /* road further ahead does not count; 0: no limit; 5000...500 000. Default 25 000 */
    int32_t obstacle_height_mm;     /* what stands higher than this is no road; 0: keep everything (then the v-disparity
                                       is that of the whole map); 100...5000. Default 400 */
    int32_t noise_millipx;          /* half width of the final band around the plane that disparity noise needs,
                                       100...3000. Default 600 */
    int32_t unevenness_mm;          /* what the road may depart from a plane: widens the band by its height in the
                                       disparity of the place; 0...200. Default 50 */
    int32_t pitch_min_urad;         /* mounting limits: a pose outside them is refused; -174 533 (-10 deg) default, */
    int32_t pitch_max_urad;         /* +261 799 (+15 deg) default; both within +-523 599 (30 deg) */
    int32_t roll_max_urad;          /* largest roll to either side, 0...610 865 (35 deg). Default 436 332 (25 deg) */
    int32_t height_min_um;          /* 200 000...height_max_um. Default 300 000 */
    int32_t height_max_um;          /* ...5 000 000. Default 4 000 000 */
    uint16_t points_min;            /* fewest road points of a pose, 16...ROADPOSE_MAX_POINTS. Default 96 */
    uint16_t support_min_permille;  /* smallest support_permille of a pose, 0...1000. Default 500 */
    int32_t range_min_mm;           /* a pose needs road at least this far ahead, 0...50 000. Default 5000 */
} roadpose_settings_t;

#endif
