/* Least squares of the disparity plane on the road points within a band around it (ours; docs/design.md). */
#ifndef ROADPOSE_REFINEMENT_H
#define ROADPOSE_REFINEMENT_H

#include "roadpose/state.h"

/* Rounds of one refinement; each looks at the points once and moves the plane once. */
#define ROADPOSE_REFINE_ROUNDS 6

/* Which points count around the present plane. */
typedef struct {
    int32_t range_min_q8;    /* the plane's disparity must be at least this */
    int64_t centre_q12;      /* corridor: lateral position of its middle, in baselines */
    int64_t half_outer_q12;  /* half width in baselines where points still count half */
    int64_t half_inner_q12;  /* and where they count full */
    int32_t band_q8;         /* half width of the band for noise, pixels */
    int32_t unevenness_q16;  /* and as a share of the disparity */
} roadpose_road_rule_t;

/* Prepares the rule for the plane and a band. Returns false when the plane is no plane. */
bool roadpose_road_rule(roadpose_road_rule_t *rule, const roadpose_plane_t *plane, const roadpose_grid_t *grid,
                        const roadpose_settings_t *settings, int32_t band_q8);

/* Half width of the noise band of a round. */
int32_t roadpose_refine_band_q8(uint8_t round, const roadpose_settings_t *settings);

void roadpose_moments_clear(roadpose_moments_t *moments);

/* Adds the points of one grid row. */
void roadpose_moments_add_row(roadpose_moments_t *moments, const roadpose_points_t *points,
                              const roadpose_plane_t *plane, const roadpose_road_rule_t *rule,
                              const roadpose_grid_t *grid, int16_t row);

/* Moves the plane by the least-squares step of the moments. Where the points do not spread sideways enough to tell
 * roll, the plane keeps a = 0 and *roll_observed is false. Returns false when not even b and c can be told. */
bool roadpose_refine_step(const roadpose_moments_t *moments, roadpose_plane_t *plane, bool *roll_observed);

#endif
