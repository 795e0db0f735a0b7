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

/* Sums of the normal equations at *fit. */
void roadpose_fit_sums(const roadpose_heading_t *instance, const roadpose_fit_t *fit, unsigned unknowns,
                       roadpose_sums_t *sums);

/* Improves the focus, rotation kept, and measures the noise. False where the flows do not tell it. */
bool roadpose_fit_focus(const roadpose_heading_t *instance, roadpose_fit_t *fit, unsigned rounds);

/* Improves focus and rotation; the noise only falls. False where the flows do not tell them. */
bool roadpose_fit_motion(const roadpose_heading_t *instance, roadpose_fit_t *fit, unsigned rounds);

/* Robust cost (Tukey's) of a motion at a given noise, q8: about the sum of squared deviations, at most
 * ROADPOSE_COST_OUTLIER_Q8 for each flow. */
#define ROADPOSE_COST_OUTLIER_Q8 901
int64_t roadpose_fit_cost(const roadpose_heading_t *instance, const roadpose_expansion_t *motion, int32_t noise_q22);

/* Counts the flows that agree with *fit. */
uint16_t roadpose_fit_agreeing(const roadpose_heading_t *instance, const roadpose_fit_t *fit);

/* Limits of the noise: 0.08 px and 1.5 px, in q22. */
int32_t roadpose_noise_min_q22(const roadpose_heading_t *instance);
int32_t roadpose_noise_max_q22(const roadpose_heading_t *instance);

#endif
