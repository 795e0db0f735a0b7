/* From a flow field to a yaw: search, fits with and without rotation, choice between them, gates. */
#include <stddef.h>

#include "heading/expansion_fit.h"
#include "heading/flow_field.h"
#include "heading/focus_search.h"
#include "heading/heading.h"
#include "heading/yaw_angle.h"

#define HYPOTHESES 48u
#define HYPOTHESES_TURNING 4u /* for each of the rotations that are tried */
#define HYPOTHESES_DOUBTFUL 16u
#define DOUBTFUL_NOISE_PERCENT 45 /* of a pixel */
#define DOUBTFUL_SHARE_PERCENT 75u
#define FOCUS_ROUNDS 2u, 1u /* coarse, fine */
#define MOTION_ROUNDS 2u, 1u /* and a last one, which tells what the fit leaves open */
#define LAST_ROUNDS 1u
#define LAST_ROUNDS_TURNED 2u /* the focus has just been moved */
#define BETTER_Q8 2048       /* a fit that began in a turn must cost this much less: 8 squared deviations */
#define SIGNIFICANT_Q8 2048  /* below this chi-square (three degrees of freedom: 95 % quantile 7.8) no rotation is seen */
#define OUTLIERS_Q8 8192     /* more where tracks disagree, times their share squared */
#define START_NOISE_PERCENT 70
#define TURN_MAX_Q24 838861  /* 1/20 rad between two frames */
#define MICRO INT64_C(1000000)

/* What the fits say; deviations in q22. */
typedef struct {
    roadpose_fit_t focus;    /* rotation as given by the vehicle, or none */
    roadpose_fit_t motion;   /* with a rotation */
    roadpose_fit_t chosen;
    int32_t rate_deviation;  /* of the fitted rotation about the vertical, a frame */
    int32_t free_deviation;  /* of the focus along the road, with a rotation */
    int32_t deviation;       /* of the chosen focus along the road */
    uint16_t agreeing;       /* moving tracks that agree with it */
    int32_t left_q16;        /* share of the found rotation that is taken for noise, 0...65536 */
} outcome_t;

static int64_t q24_of_urad(int64_t urad) {
    return urad * (INT64_C(1) << 24) / MICRO;
}

static int64_t urad_of_q22(int64_t q22) {
    return roadpose_floor_shift(q22 * MICRO, 22);
}

/* The vehicle's rotation between the frames, q24; rate within +-2^31 urad/s, interval <= 1e7 us: below 2^55. */
static int64_t vehicle_turn_q24(const roadpose_motion_t *motion) {
    if (!motion->has_yaw_rate) {
        return 0;
    }
    return q24_of_urad((int64_t)motion->yaw_rate_urad_s * motion->interval_us / MICRO);
}

/* Turning to the left is a rotation about up = -n. */
static void turn_about_normal(int64_t left_q24, const int32_t *normal_q30, int32_t *turn_q24) {
    for (unsigned i = 0; i < 3; i++) {
        turn_q24[i] = (int32_t)roadpose_floor_shift(-left_q24 * normal_q30[i], 30);
    }
}

static int64_t left_turn_q24(const int32_t *turn_q24, const int32_t *normal_q30) {
    int64_t sum_q54 = 0;
    for (unsigned i = 0; i < 3; i++) {
        sum_q54 -= (int64_t)turn_q24[i] * normal_q30[i];
    }
    return roadpose_floor_shift(sum_q54, 30);
}

/* Rates a frame to rates a second. |x| < 2^23 q24 rad -> below 2^19 urad, times 1e6: below 2^39. */
static int32_t rate_urad_s(int64_t q24, int32_t interval_us) {
    return roadpose_clamp32(roadpose_floor_shift(q24 * MICRO, 24) * MICRO / interval_us);
}

static uint8_t vehicle_gate(const roadpose_heading_t *instance, const roadpose_motion_t *motion) {
    if (motion->has_speed && motion->speed_mm_s < instance->settings.speed_min_mm_s) {
        return ROADPOSE_YAW_SLOW;
    }
    const int64_t limit = instance->settings.yaw_rate_max_urad_s;
    const bool sharp = motion->has_yaw_rate && roadpose_abs(motion->yaw_rate_urad_s) > limit;
    const bool far = roadpose_abs(vehicle_turn_q24(motion)) > TURN_MAX_Q24;
    return (sharp || far) ? ROADPOSE_YAW_TURNING : ROADPOSE_YAW_OK;
}

static uint8_t track_gate(const roadpose_heading_t *instance, const roadpose_yaw_t *yaw) {
    if (yaw->tracks_used < instance->settings.tracks_min) {
        return ROADPOSE_YAW_FEW_TRACKS;
    }
    const bool few = yaw->tracks_moving < instance->settings.tracks_min || yaw->tracks_moving * 5u < yaw->tracks_used;
    return few ? ROADPOSE_YAW_STANDING : ROADPOSE_YAW_OK;
}

/* The better of two free fits; *other loses a near tie. */
static void take_cheaper(const roadpose_heading_t *instance, roadpose_fit_t *fit, const roadpose_fit_t *other) {
    const int32_t noise = (other->noise_q22 < fit->noise_q22) ? other->noise_q22 : fit->noise_q22;
    if (roadpose_fit_cost(instance, &other->motion, noise) + BETTER_Q8 <
        roadpose_fit_cost(instance, &fit->motion, noise)) {
        *fit = *other;
    }
}

/* The free fit, begun at the focus; where the vehicle gives no yaw rate begun in a turn as well, if a turn scores
 * better, and only there if it scores much better. */
static bool fit_free(roadpose_heading_t *instance, bool rate_known, uint32_t score, uint32_t *random, outcome_t *out) {
    const int32_t start = roadpose_noise_max_q22(instance) * START_NOISE_PERCENT / 150;
    roadpose_fit_t turning = {.motion = {{0, 0}, {0, 0, 0}}, .noise_q22 = start};
    const uint32_t turning_score =
        rate_known ? 0 : roadpose_focus_search_turning(instance, HYPOTHESES_TURNING, random, &turning.motion);
    out->motion = out->focus;
    out->motion.noise_q22 = (start > out->focus.noise_q22) ? start : out->focus.noise_q22;
    if (turning_score * 8u > score * 9u) {
        out->motion = turning;
        return roadpose_fit_rounds(instance, &out->motion, ROADPOSE_UNKNOWNS_MOTION, MOTION_ROUNDS);
    }
    const bool found = roadpose_fit_rounds(instance, &out->motion, ROADPOSE_UNKNOWNS_MOTION, MOTION_ROUNDS);
    if (turning_score <= score || !roadpose_fit_rounds(instance, &turning, ROADPOSE_UNKNOWNS_MOTION, MOTION_ROUNDS)) {
        return found;
    }
    if (!found) {
        out->motion = turning;
        return true;
    }
    take_cheaper(instance, &out->motion, &turning);
    return true;
}

/* A false focus in a turn is a loose crowd of about half of the tracks. Such a fit is checked by a longer search. */
static bool is_doubtful(const roadpose_heading_t *instance, const outcome_t *out) {
    return out->motion.noise_q22 > instance->lens.px_q22 * DOUBTFUL_NOISE_PERCENT / 100 &&
           instance->round.agreeing * 100u < instance->flows_moving * DOUBTFUL_SHARE_PERCENT;
}

static void check_doubtful(roadpose_heading_t *instance, uint32_t *random, outcome_t *out) {
    roadpose_fit_t turning = {.motion = {{0, 0}, {0, 0, 0}},
                              .noise_q22 = roadpose_noise_max_q22(instance) * START_NOISE_PERCENT / 150};
    if (roadpose_focus_search_turning(instance, HYPOTHESES_DOUBTFUL, random, &turning.motion) != 0 &&
        roadpose_fit_rounds(instance, &turning, ROADPOSE_UNKNOWNS_MOTION, MOTION_ROUNDS)) {
        take_cheaper(instance, &out->motion, &turning);
    }
}

/* Rotation found beyond the given one, in the order and scale of the unknowns: q28, clamped to 2^27. */
static void excess_turn(const outcome_t *out, int32_t *turn_q28) {
    static const unsigned AXIS[3] = {0, 2, 1};
    for (unsigned i = 0; i < 3; i++) {
        const int64_t excess = (int64_t)out->motion.motion.turn_q24[AXIS[i]] - out->focus.motion.turn_q24[AXIS[i]];
        turn_q28[i] = (int32_t)roadpose_clamp(excess * 16, -(INT32_C(1) << 27), INT32_C(1) << 27);
    }
}

/* Shrinks the found rotation by what chance explains of it (James and Stein's estimator, positive part), and lets the
 * focus follow; an insignificant rotation leaves the fit without one. */
static void choose(const roadpose_factors_t *factors, int64_t chance_q8, outcome_t *out) {
    int32_t turn_q28[3];
    int32_t focus_q28[2];
    excess_turn(out, turn_q28);
    const int64_t significance = roadpose_turn_significance(factors, turn_q28, out->motion.noise_q22);
    out->left_q16 = 65536;
    out->chosen = out->focus;
    if (significance <= chance_q8) {
        return;
    }
    out->left_q16 = (int32_t)(INT64_C(65536) * chance_q8 / significance);
    for (unsigned i = 0; i < 3; i++) {
        turn_q28[i] = (int32_t)-roadpose_floor_shift((int64_t)turn_q28[i] * out->left_q16, 16);
    }
    roadpose_follow(factors, turn_q28, focus_q28);
    out->chosen = out->motion;
    out->chosen.motion.turn_q24[0] += roadpose_floor_shift32(turn_q28[0], 4);
    out->chosen.motion.turn_q24[2] += roadpose_floor_shift32(turn_q28[1], 4);
    out->chosen.motion.turn_q24[1] += roadpose_floor_shift32(turn_q28[2], 4);
    out->chosen.motion.focus_q24[0] = (int32_t)roadpose_clamp((int64_t)out->chosen.motion.focus_q24[0] + focus_q28[0],
                                                              -(1 << 24), 1 << 24);
    out->chosen.motion.focus_q24[1] = (int32_t)roadpose_clamp((int64_t)out->chosen.motion.focus_q24[1] + focus_q28[1],
                                                              -(1 << 24), 1 << 24);
}

/* Direction of the image in which yaw moves the focus; a focus unknown is a sixteenth of the focus. */
static void yaw_direction(const int32_t *normal_q30, int32_t *c_q16) {
    c_q16[0] = roadpose_floor_shift32(normal_q30[1], 10);
    c_q16[1] = -roadpose_floor_shift32(normal_q30[0], 10);
    c_q16[2] = 0;
    c_q16[3] = 0;
    c_q16[4] = 0;
}

/* Chi-square that chance may reach. Things that move by themselves do not scatter like noise: some of them always lie
 * where a small rotation would bring them, so it grows with the share of moving tracks that disagree: share <= 1. */
static int64_t chance_q8(const roadpose_heading_t *instance) {
    const int64_t moving = instance->flows_moving;
    const int64_t disagreeing = moving - instance->round.agreeing;
    return SIGNIFICANT_Q8 + ((moving == 0) ? 0 : OUTLIERS_Q8 * disagreeing * disagreeing / (moving * moving));
}

/* What the free fit leaves open, and the choice. */
static void judge(const roadpose_heading_t *instance, const int32_t *along_q16, outcome_t *out) {
    const int32_t about_y_q16[ROADPOSE_UNKNOWNS_MOTION] = {0, 0, 0, 0, 65536};
    const roadpose_factors_t *factors = &instance->round.factors;
    out->motion.noise_q22 = instance->round.noise_q22;
    const int32_t noise = out->motion.noise_q22;
    choose(factors, chance_q8(instance), out);
    out->free_deviation = roadpose_deviation(factors, ROADPOSE_UNKNOWNS_MOTION, along_q16, noise);
    out->rate_deviation = roadpose_deviation(factors, ROADPOSE_UNKNOWNS_MOTION, about_y_q16, noise);
}

/* Fits, choice, and what they leave open. False: the tracks do not tell one focus. */
static bool solve(roadpose_heading_t *instance, bool rate_known, const int32_t *normal_q30, outcome_t *out) {
    uint32_t random = instance->settings.seed;
    int32_t along_q16[ROADPOSE_UNKNOWNS_MOTION];
    roadpose_voters_choose(instance, out->focus.motion.turn_q24);
    const uint32_t score = roadpose_focus_search(instance, HYPOTHESES, &random, &out->focus.motion);
    out->focus.noise_q22 = roadpose_noise_max_q22(instance);
    if (score == 0 || !roadpose_fit_rounds(instance, &out->focus, ROADPOSE_UNKNOWNS_FOCUS, FOCUS_ROUNDS) ||
        !fit_free(instance, rate_known, score, &random, out)) {
        return false;
    }
    if (!rate_known && is_doubtful(instance, out)) {
        check_doubtful(instance, &random, out);
    }
    if (!roadpose_fit_round(instance, &out->motion, ROADPOSE_UNKNOWNS_MOTION, 1)) {
        return false;
    }
    yaw_direction(normal_q30, along_q16);
    judge(instance, along_q16, out);
    const unsigned rounds = (out->left_q16 < 65536) ? LAST_ROUNDS_TURNED : LAST_ROUNDS;
    if (!roadpose_fit_rounds(instance, &out->chosen, ROADPOSE_UNKNOWNS_FOCUS, 0, rounds)) {
        return false;
    }
    out->agreeing = instance->round.agreeing;
    out->deviation = roadpose_deviation(&instance->round.factors, ROADPOSE_UNKNOWNS_FOCUS, along_q16,
                                        out->chosen.noise_q22);
    return true;
}

/* Standard deviation of the yaw: of the chosen fit; where a rotation was seen, also what that rotation leaves open, and
 * what the shrinking moved. Each below 2^22; squares below 2^44. */
static int32_t sigma_urad(const outcome_t *out, const int32_t *normal_q30) {
    const int64_t own = out->deviation;
    int64_t square = own * own;
    if (out->left_q16 < 65536) {
        const int64_t unheld = out->free_deviation;
        const int64_t moved_urad = (int64_t)roadpose_yaw_angle(out->motion.motion.focus_q24, normal_q30) -
                                   roadpose_yaw_angle(out->chosen.motion.focus_q24, normal_q30);
        const int64_t moved = moved_urad * (INT64_C(1) << 22) / MICRO;
        square = ((unheld * unheld > square) ? unheld * unheld : square) + moved * moved;
    }
    return roadpose_clamp32(urad_of_q22((int64_t)roadpose_sqrt((uint64_t)square)));
}

/* Figures that are told whatever the status. */
static void report(const roadpose_heading_t *instance, const roadpose_motion_t *motion, const int32_t *normal_q30,
                   const outcome_t *out, roadpose_yaw_t *yaw) {
    const roadpose_lens_t *lens = &instance->lens;
    const int64_t noise_millipx = (int64_t)out->chosen.noise_q22 * 1000 / lens->px_q22;
    yaw->noise_millipx = (uint16_t)roadpose_clamp(noise_millipx, 0, UINT16_MAX);
    yaw->tracks_agreeing = out->agreeing;
    /* focus * f: 2^24 * 2^22 millipx; q24 millipx to q8 px */
    yaw->focus_u_q8 =
        lens->cu_q8 + (int32_t)((int64_t)out->chosen.motion.focus_q24[0] * lens->focal_millipx / 65536000);
    yaw->focus_v_q8 =
        lens->cv_q8 + (int32_t)((int64_t)out->chosen.motion.focus_q24[1] * lens->focal_millipx / 65536000);
    yaw->yaw_rate_urad_s = rate_urad_s(left_turn_q24(out->motion.motion.turn_q24, normal_q30), motion->interval_us);
    yaw->yaw_rate_sigma_urad_s = rate_urad_s((int64_t)out->rate_deviation * 4, motion->interval_us);
}

static bool agree_enough(const roadpose_heading_t *instance, const roadpose_yaw_t *yaw) {
    const uint32_t share = instance->settings.share_min_permille;
    return yaw->tracks_agreeing >= instance->settings.tracks_min &&
           (uint32_t)yaw->tracks_agreeing * 1000u >= share * yaw->tracks_moving;
}

/* The gates that need the fits, in the order of the statuses. */
static uint8_t fit_gate(const roadpose_heading_t *instance, const roadpose_motion_t *motion, const outcome_t *out,
                        int32_t sigma, const roadpose_yaw_t *yaw) {
    const bool rate_known = motion->has_yaw_rate;
    const bool moves = motion->has_speed; /* fast enough, or this frame would not have come here */
    const roadpose_heading_settings_t *s = &instance->settings;
    const int64_t rate = roadpose_abs(yaw->yaw_rate_urad_s);
    const int64_t unsure = yaw->yaw_rate_sigma_urad_s;
    const bool unseen = !rate_known && unsure > s->rate_sigma_max_urad_s;
    if (!unseen && rate + (rate_known ? -2 * unsure : unsure) > s->yaw_rate_max_urad_s) {
        return ROADPOSE_YAW_TURNING;
    }
    if (!agree_enough(instance, yaw)) {
        return ROADPOSE_YAW_NO_FOCUS;
    }
    if (!moves && yaw->tracks_agreeing * 4u < yaw->tracks_used) {
        return ROADPOSE_YAW_STANDING;
    }
    if (yaw->noise_millipx > s->noise_max_millipx) {
        return ROADPOSE_YAW_NOISY;
    }
    if (unseen) {
        return ROADPOSE_YAW_AMBIGUOUS;
    }
    const bool open = !rate_known && urad_of_q22(out->free_deviation) > 2 * (int64_t)s->sigma_max_urad;
    return (open || sigma > s->sigma_max_urad) ? ROADPOSE_YAW_UNCERTAIN : ROADPOSE_YAW_OK;
}

static void fill_angles(const roadpose_heading_t *instance, const outcome_t *out, const int32_t *normal_q30,
                        int32_t sigma, roadpose_yaw_t *yaw) {
    const int32_t *focus = out->chosen.motion.focus_q24;
    const int32_t angle = roadpose_yaw_angle(focus, normal_q30);
    if (roadpose_abs(angle) > instance->settings.yaw_max_urad) {
        yaw->status = ROADPOSE_YAW_OUTSIDE_LIMITS;
        return;
    }
    yaw->yaw_urad = angle;
    yaw->sigma_urad = sigma;
    yaw->pitch_difference_urad = roadpose_descent(focus, normal_q30);
    yaw->pitch_motion_urad = roadpose_pitch_of_normal(normal_q30) - yaw->pitch_difference_urad;
}

void roadpose_heading_estimate(roadpose_heading_t *instance, const roadpose_motion_t *motion, const int32_t *normal_q30,
                               roadpose_yaw_t *yaw) {
    static const int32_t DOWN_Q30[3] = {0, INT32_C(1) << 30, 0};
    const int32_t *normal = (normal_q30 != NULL) ? normal_q30 : DOWN_Q30;
    outcome_t out = {.left_q16 = 0};
    yaw->status = vehicle_gate(instance, motion);
    if (yaw->status == ROADPOSE_YAW_OK) {
        yaw->status = track_gate(instance, yaw);
    }
    if (yaw->status != ROADPOSE_YAW_OK) {
        return;
    }
    turn_about_normal(vehicle_turn_q24(motion), normal, out.focus.motion.turn_q24);
    if (!solve(instance, motion->has_yaw_rate, normal, &out)) {
        yaw->status = ROADPOSE_YAW_NO_FOCUS;
        return;
    }
    report(instance, motion, normal, &out, yaw);
    const int32_t sigma = sigma_urad(&out, normal);
    yaw->status = fit_gate(instance, motion, &out, sigma, yaw);
    if (yaw->status == ROADPOSE_YAW_OK && normal_q30 == NULL) {
        yaw->status = ROADPOSE_YAW_NO_ROAD;
    }
    if (yaw->status == ROADPOSE_YAW_OK) {
        fill_angles(instance, &out, normal, sigma, yaw);
    }
}
