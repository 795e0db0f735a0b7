/* Least squares of the disparity plane on the road points within a band around it (ours; docs/design.md). */
#ifndef ROADPOSE_REFINEMENT_H
#define ROADPOSE_REFINEMENT_H

#include "roadpose/state.h"

/* Rounds of one refinement; each looks at the points once and moves the plane once. The first rounds take what lies
 * within a shrinking band of noise around the plane, from every eighth row where there are points enough; from
 * ROADPOSE_UNEVEN_ROUND on they follow the road where it is uneven. */
#define ROADPOSE_REFINE_ROUNDS 7
#define ROADPOSE_UNEVEN_ROUND 5

/* Looks for the assessment of a plane: within the noise band; within the widest band; and at the inner half of the
 * corridor, like an uneven round but from every eighth row. */
#define ROADPOSE_LOOK_NOISE 7
#define ROADPOSE_LOOK_WIDE 8
#define ROADPOSE_LOOK_INNER 9

/* Prepares the rule of a round, or of a look, for the plane. Returns false when the plane is no plane. Once for each look:
 * the plane stays until all its rows are in. */
bool roadpose_road_rule(roadpose_road_rule_t *rule, const roadpose_plane_t *plane, const roadpose_grid_t *grid,
                        const roadpose_settings_t *settings, uint8_t round);

/* Grid rows from one row that the round looks at to the next. */
uint16_t roadpose_refine_row_step(uint8_t round, uint16_t points);

/* Opens every distance; and, after a look at the points, closes the distances where the corridor's points near the
 * plane are not within its noise, most of them and on average: a speed bump, a dip, the foot of a kerb. A crowned road
 * stays open: there it is only the sides that depart. */
void roadpose_levels_open(roadpose_moments_t *moments);
void roadpose_levels_judge(roadpose_moments_t *moments, const roadpose_settings_t *settings);

/* Begins a look: clears the sums, not what is open, and fixes each distance's band. */
void roadpose_moments_begin(roadpose_moments_t *moments, const roadpose_road_rule_t *rule);

/* Adds the points of one grid row. */
void roadpose_moments_add_row(roadpose_moments_t *moments, roadpose_points_t *points, const roadpose_plane_t *plane,
                              const roadpose_road_rule_t *rule, const roadpose_grid_t *grid, int16_t row);

/* Moves the plane by the least-squares step of the moments. Where the points do not spread sideways enough to tell
 * roll, the plane keeps the slope that the method gave it (0 by Method 1), which pitch and height need, and
 * *roll_observed is false. Returns false when not even b and c can be told. */
bool roadpose_refine_step(const roadpose_moments_t *moments, roadpose_plane_t *plane, bool *roll_observed);

/* Largest turn of the plane about the direction of travel, tan(roll) in Q16.
 * By following the uneven road: 0.29 degrees. On crowned streets it was up to 0.24 degrees, on flat ones 0.01; a kerb
 * within the corridor, 6 to 10 cm high on one side, turned it by 0.6 to 1.5 degrees.
 * Between the inner half of the corridor and all of it: 0.5 degrees. A plane that leans on a kerb misses the lane by
 * more. */
#define ROADPOSE_UNEVEN_TURN_MAX_Q16 328
#define ROADPOSE_INNER_TURN_MAX_Q16 572

bool roadpose_turned_too_far(const roadpose_plane_t *before, const roadpose_plane_t *after, int32_t max_q16);

#endif
