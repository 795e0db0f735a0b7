/* Robust fit of the camera's motion to the flow field: the focus of expansion alone, or with a rotation. */
#ifndef ROADPOSE_HEADING_EXPANSION_FIT_H
#define ROADPOSE_HEADING_EXPANSION_FIT_H

#include "heading/expansion.h"
#include "heading/normal_equations.h"
#include "roadpose/heading.h"

/* A motion and the standard deviation of the flow across its direction of expansion. */
typedef struct {
    roadpose_expansion_t motion;
    int32_t noise_q22;
} roadpose_fit_t;

/* One pass over every stride-th flow, and the step that it asks for. instance->round then tells the sums, factors, cost
 * and noise where the pass was made; fit->noise_q22 is that noise (with a rotation: the noise only falls). False where the
 * flows do not tell the unknowns. */
bool roadpose_fit_round(roadpose_heading_t *instance, roadpose_fit_t *fit, unsigned unknowns, unsigned stride);

/* Coarse rounds, which look at part of the flows. */
bool roadpose_fit_rounds(roadpose_heading_t *instance, roadpose_fit_t *fit, unsigned unknowns, unsigned rounds);

/* After a round with a rotation: the step of the focus alone that the same sums ask for. */
void roadpose_fit_focus_alone(roadpose_heading_t *instance, roadpose_fit_t *fit);

/* Robust cost (Tukey's) of a fit at its noise, q8: about the sum of squared deviations, at most
 * ROADPOSE_COST_OUTLIER_Q8 for each flow. Leaves the factors alone. */
#define ROADPOSE_COST_OUTLIER_Q8 1045
int32_t roadpose_fit_cost(roadpose_heading_t *instance, const roadpose_fit_t *fit);

/* Limits of the noise: 0.08 px and 1.5 px, in q22. */
int32_t roadpose_noise_min_q22(const roadpose_heading_t *instance);
int32_t roadpose_noise_max_q22(const roadpose_heading_t *instance);

#endif
