#include "heading/running_yaw.h"

#include <string.h>

#include "fixed_point/fixed_point.h"

#define SPREAD_MIN_URAD 175   /* 0.01 degrees: identical values must not make the spread 0 */
#define COMMON_ERROR_URAD 873 /* 0.05 degrees: what two frames share, so that no single frame rules */
#define FREE_LIMIT_URAD 17453 /* 1 degree: a free fit far off must not rule */
#define DRIFT_FRAMES 8        /* fewer tell no drift */
#define DRIFT_CHANCE 9        /* squared deviations of the mean that are taken for chance */
#define CUT_QUARTERS 16       /* Tukey's biweight ends at four spreads */

void roadpose_running_clear(roadpose_heading_t *instance) {
    instance->history_next = 0;
    memset(&instance->running, 0, sizeof instance->running);
}

/* Ascending; at most ROADPOSE_YAW_HISTORY^2 / 2 moves. */
static void sort(int32_t *values, unsigned count) {
    for (unsigned i = 1; i < count; i++) {
        const int32_t value = values[i];
        unsigned k = i;
        while (k > 0 && values[k - 1] > value) {
            values[k] = values[k - 1];
            k--;
        }
        values[k] = value;
    }
}

static int32_t median(int32_t *values, unsigned count) {
    sort(values, count);
    return (int32_t)roadpose_floor_shift((int64_t)values[(count - 1) / 2] + values[count / 2], 1);
}

/* Median distance from the median, times 1.4826. Yaws are below 2^22 urad. */
static int32_t spread_about(roadpose_heading_t *instance, int32_t middle_urad) {
    const unsigned count = instance->running.count;
    for (unsigned i = 0; i < count; i++) {
        instance->sorted_urad[i] = (int32_t)roadpose_abs((int64_t)instance->history_urad[i] - middle_urad);
    }
    const int64_t spread = (int64_t)median(instance->sorted_urad, count) * 1518 / 1024;
    return (int32_t)roadpose_clamp(spread, SPREAD_MIN_URAD, INT32_MAX);
}

/* Biweight about the middle over the variance: (1 - u^2)^2 (q12) * 2^34 / (sigma^2 + common^2).
 * off <= 2^23, u <= 2^12 in q12; sigma <= 100 000: variance 2^19.5...2^33.3; weight <= 2^46 / 2^19 = 2^27. */
static int64_t weight_of(const roadpose_heading_t *instance, unsigned i, int32_t middle_urad, int64_t cut_urad) {
    const int64_t off = roadpose_abs((int64_t)instance->history_urad[i] - middle_urad);
    if (off >= cut_urad) {
        return 0;
    }
    const int64_t u_q12 = off * 4096 / cut_urad;
    const int64_t rest_q12 = 4096 - ((u_q12 * u_q12) >> 12);
    const int64_t sigma = instance->history_sigma_urad[i];
    const int64_t variance = sigma * sigma + (int64_t)COMMON_ERROR_URAD * COMMON_ERROR_URAD;
    return ((rest_q12 * rest_q12) >> 12) * (INT64_C(1) << 34) / variance;
}

/* A rotation that is small in each frame but the same in all stays below what a frame can tell, and biases its yaw. The
 * frames together tell it: the mean of what a free rotation would change, less what chance explains of it (James and
 * Stein's estimator, positive part). |free| < 2^15: 256 squares below 2^38, the mean's
 * square below 2^30, times DRIFT_CHANCE or the mean below 2^45. */
static int32_t drift_urad(const roadpose_heading_t *instance) {
    const int64_t count = instance->running.count;
    int64_t sum = 0;
    int64_t squares = 0;
    for (unsigned i = 0; i < instance->running.count; i++) {
        const int64_t free_urad = instance->history_free_urad[i];
        sum += free_urad;
        squares += free_urad * free_urad;
    }
    const int64_t mean = sum / count;
    const int64_t variance = squares / count - mean * mean; /* of one frame */
    const int64_t chance = variance * DRIFT_CHANCE / count;
    const int64_t square = mean * mean;
    return (count < DRIFT_FRAMES || square <= chance) ? 0 : (int32_t)(mean - mean * chance / square);
}

/* Sum of 256 weights of 2^27 times offsets of 2^23: below 2^58. */
static void estimate(roadpose_heading_t *instance) {
    roadpose_running_yaw_t *running = &instance->running;
    memcpy(instance->sorted_urad, instance->history_urad, running->count * sizeof instance->sorted_urad[0]);
    const int32_t middle = median(instance->sorted_urad, running->count);
    running->spread_urad = spread_about(instance, middle);
    const int64_t cut = (int64_t)running->spread_urad * CUT_QUARTERS / 4;
    int64_t weights = 0;
    int64_t offsets = 0;
    for (unsigned i = 0; i < running->count; i++) {
        const int64_t weight = weight_of(instance, i, middle, cut);
        weights += weight;
        offsets += weight * ((int64_t)instance->history_urad[i] - middle);
    }
    running->yaw_urad = drift_urad(instance) + ((weights == 0) ? middle : (int32_t)(middle + offsets / weights));
}

void roadpose_running_add(roadpose_heading_t *instance, const roadpose_yaw_t *yaw) {
    roadpose_running_yaw_t *running = &instance->running;
    if (yaw->status != ROADPOSE_YAW_OK) {
        running->refused[yaw->status]++;
        return;
    }
    instance->history_urad[instance->history_next] = yaw->yaw_urad;
    instance->history_sigma_urad[instance->history_next] = yaw->sigma_urad;
    instance->history_free_urad[instance->history_next] =
        (int16_t)roadpose_clamp(instance->free_urad, -FREE_LIMIT_URAD, FREE_LIMIT_URAD);
    instance->history_next = (uint16_t)((instance->history_next + 1u) % ROADPOSE_YAW_HISTORY);
    if (running->count < ROADPOSE_YAW_HISTORY) {
        running->count++;
    }
    running->accepted++;
    estimate(instance);
}
