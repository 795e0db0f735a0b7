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

/* Normal equations at *fit, and what its flows show there. */
typedef struct {
    roadpose_sums_t sums;
    int32_t noise_q22;
    uint16_t agreeing; /* moving flows within three deviations of *fit that stream away from the focus */
} roadpose_pass_t;

/* One pass over every stride-th flow. */
void roadpose_fit_pass(const roadpose_heading_t *instance, const roadpose_fit_t *fit, unsigned unknowns,
                       unsigned stride, roadpose_pass_t *pass);

/* Improves the focus, rotation kept, and measures the noise, in coarse rounds and then fine ones. False where the flows do not tell it. */
bool roadpose_fit_focus(const roadpose_heading_t *instance, roadpose_fit_t *fit, unsigned coarse, unsigned fine);

/* Improves focus and rotation; the noise only falls. False where the flows do not tell them. */
bool roadpose_fit_motion(const roadpose_heading_t *instance, roadpose_fit_t *fit, unsigned coarse, unsigned fine);

/* Robust cost (Tukey's) of a motion at a given noise, q8: about the sum of squared deviations, at most
 * ROADPOSE_COST_OUTLIER_Q8 for each flow. */
#define ROADPOSE_COST_OUTLIER_Q8 901
int64_t roadpose_fit_cost(const roadpose_heading_t *instance, const roadpose_expansion_t *motion, int32_t noise_q22);

/* Limits of the noise: 0.08 px and 1.5 px, in q22. */
int32_t roadpose_noise_min_q22(const roadpose_heading_t *instance);
int32_t roadpose_noise_max_q22(const roadpose_heading_t *instance);

#endif
