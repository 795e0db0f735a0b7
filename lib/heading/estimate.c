/* From a flow field to a yaw: search, fits with and without rotation, choice between them, gates. */
#include <stddef.h>
#include <string.h>

#include "heading/expansion_fit.h"
#include "heading/flow_field.h"
#include "heading/focus_search.h"
#include "heading/heading.h"
#include "heading/yaw_angle.h"

#define PAIRS 40u
#define PAIRS_TURNING 8u          /* for each of the rotations that are tried */
#define START_FOCUS_PERCENT 70    /* of a pixel: noise that a fit begins with */
#define START_TURNING_PERCENT 50
#define COARSE_FOCUS 3u           /* rounds */
#define COARSE_TURNING 3u
#define SIGNIFICANT_Q8 2048       /* below this chi-square (three degrees of freedom: 95 % quantile 7.8) no rotation is seen */
#define OUTLIERS_Q8 8192          /* more where tracks disagree, times their share squared */
#define LOOK_CLOSER 3             /* a third of that is worth a free fit */
#define SAVING_Q8 1024            /* a rotation must cost this much less */
#define RIVAL_Q8 5120             /* a turn that costs no more than this more is not excluded */
#define CLEAR_PERCENT 75u         /* of the moving tracks agree: no crowd of other things is as large */
#define TURNED_PERCENT 60u        /* of them must agree with a motion that was found by the search for a turn */
#define UNTOLD_NOISE_PERCENT 90   /* of the largest noise: a false focus in a turn is a loose crowd */
#define SURE 3                    /* deviations by which a turn must be excluded where the vehicle tells no yaw rate */
#define TURN_MAX_Q24 838861       /* 1/20 rad between two frames */
#define MICRO INT64_C(1000000)

/* What is asked, and what the fits say; deviations in q22. */
typedef struct {
    const int32_t *normal_q30; /* of the road */
    int64_t turn_max_q24;    /* between the two frames, that still gives a yaw */
    roadpose_fit_t focus;    /* rotation as given by the vehicle, or none */
    roadpose_fit_t motion;   /* with a rotation */
    roadpose_fit_t chosen;
    int64_t significance_q8; /* of the rotation: chi-square */
    int32_t chance_q8;       /* what chance may reach of it */
    int32_t rate_deviation;  /* of the fitted rotation about the vertical, a frame */
    int32_t free_deviation;  /* of the focus along the road, with a rotation */
    int32_t deviation;       /* of the chosen focus along the road */
    int32_t left_q16;        /* share of the found rotation that is taken for noise, 0...65536 */
    int32_t rival_q24[3];    /* a rotation that explains the flows about as well as none, or none */
    uint16_t agreeing;       /* moving tracks that agree with the chosen focus */
    bool turned;             /* the search for a turn found the motion */
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

static int32_t smaller(int32_t a, int32_t b) {
    return (a < b) ? a : b;
}

static int32_t noise_q22(const roadpose_heading_t *instance, int32_t percent) {
    return instance->lens.px_q22 * percent / 100;
}

/* Robust cost of a fit at a noise, which two fits must have in common to be compared. */
static int32_t cost_at(roadpose_heading_t *instance, const roadpose_fit_t *fit, int32_t noise) {
    roadpose_fit_t same = *fit;
    same.noise_q22 = noise;
    return roadpose_fit_cost(instance, &same);
}

/* Chi-square that chance may reach. Things that move by themselves do not scatter like noise: some of them always lie
 * where a small rotation would bring them, so it grows with the share of moving tracks that disagree: share <= 1. */
static int32_t chance_q8(const roadpose_heading_t *instance) {
    const int32_t moving = instance->flows_moving;
    const int32_t disagreeing = moving - instance->round.agreeing;
    return SIGNIFICANT_Q8 + ((moving == 0) ? 0 : OUTLIERS_Q8 * disagreeing / moving * disagreeing / moving);
}

/* A free fit begun in the turn that scores best. True if it costs less than the focus without a rotation, by more than
 * three more unknowns and the choice among many explain. If it costs about as much, it is remembered as a rival. */
static bool find_turn(roadpose_heading_t *instance, uint32_t *random, outcome_t *out) {
    roadpose_fit_t turning = {.motion = {{0, 0}, {0, 0, 0}}, .noise_q22 = noise_q22(instance, START_TURNING_PERCENT)};
    if (roadpose_focus_search_turning(instance, PAIRS_TURNING, random, &turning.motion) == 0 ||
        !roadpose_fit_rounds(instance, &turning, ROADPOSE_UNKNOWNS_MOTION, COARSE_TURNING)) {
        return false;
    }
    const int32_t noise = smaller(turning.noise_q22, out->focus.noise_q22);
    const int32_t cost = cost_at(instance, &turning, noise);
    const int32_t straight = cost_at(instance, &out->focus, noise);
    if (cost + SIGNIFICANT_Q8 + (out->chance_q8 - SIGNIFICANT_Q8) / 2 < straight) {
        out->motion = turning;
        return true;
    }
    if (cost < straight + RIVAL_Q8) {
        memcpy(out->rival_q24, turning.motion.turn_q24, sizeof out->rival_q24);
    }
    return false;
}

/* Rotation found beyond the given one, in the order and scale of the unknowns: q28, clamped to 2^27. */
static void excess_turn(const outcome_t *out, int32_t *turn_q28) {
    static const unsigned AXIS[3] = {0, 2, 1};
    for (unsigned i = 0; i < 3; i++) {
        const int64_t excess = (int64_t)out->motion.motion.turn_q24[AXIS[i]] - out->focus.motion.turn_q24[AXIS[i]];
        turn_q28[i] = (int32_t)roadpose_clamp(excess * 16, -(INT32_C(1) << 27), INT32_C(1) << 27);
    }
}

/* Takes left_q16 of the found rotation back, and lets the focus follow. */
static void shrink(const roadpose_factors_t *factors, outcome_t *out) {
    int32_t turn_q28[3];
    int32_t focus_q28[2];
    excess_turn(out, turn_q28);
    for (unsigned i = 0; i < 3; i++) {
        turn_q28[i] = (int32_t)-roadpose_floor_shift((int64_t)turn_q28[i] * out->left_q16, 16);
    }
    roadpose_follow(factors, turn_q28, focus_q28);
    out->chosen = out->motion;
    out->chosen.motion.turn_q24[0] += roadpose_floor_shift32(turn_q28[0], 4);
    out->chosen.motion.turn_q24[2] += roadpose_floor_shift32(turn_q28[1], 4);
    out->chosen.motion.turn_q24[1] += roadpose_floor_shift32(turn_q28[2], 4);
    for (unsigned i = 0; i < 2; i++) {
        out->chosen.motion.focus_q24[i] = (int32_t)roadpose_clamp((int64_t)out->chosen.motion.focus_q24[i] + focus_q28[i],
                                                                  -(1 << 24), 1 << 24);
    }
}

/* Direction of the image in which yaw moves the focus; a focus unknown is a sixteenth of the focus. */
static void yaw_direction(const int32_t *normal_q30, int32_t *c_q16) {
    c_q16[0] = roadpose_floor_shift32(normal_q30[1], 10);
    c_q16[1] = -roadpose_floor_shift32(normal_q30[0], 10);
    c_q16[2] = 0;
    c_q16[3] = 0;
    c_q16[4] = 0;
}

/* What a free fit leaves open, and how far its rotation is from the given one. */
static void judge(const roadpose_heading_t *instance, const int32_t *along_q16, outcome_t *out) {
    static const int32_t ABOUT_Y_Q16[ROADPOSE_UNKNOWNS_MOTION] = {0, 0, 0, 0, 65536};
    const roadpose_factors_t *factors = &instance->round.factors;
    const int32_t noise = instance->round.noise_q22;
    int32_t turn_q28[3];
    excess_turn(out, turn_q28);
    out->significance_q8 = roadpose_turn_significance(factors, turn_q28, noise);
    out->free_deviation = roadpose_deviation(factors, ROADPOSE_UNKNOWNS_MOTION, along_q16, noise);
    out->rate_deviation = roadpose_deviation(factors, ROADPOSE_UNKNOWNS_MOTION, ABOUT_Y_Q16, noise);
}

/* The last round, of the chosen fit. */
static bool conclude(roadpose_heading_t *instance, const int32_t *along_q16, outcome_t *out) {
    if (!roadpose_fit_round(instance, &out->chosen, ROADPOSE_UNKNOWNS_FOCUS, 1)) {
        return false;
    }
    out->agreeing = instance->round.agreeing;
    out->deviation = roadpose_deviation(&instance->round.factors, ROADPOSE_UNKNOWNS_FOCUS, along_q16,
                                        out->chosen.noise_q22);
    return true;
}

/* The focus without a rotation, and, from the same sums, what a rotation would change. */
static bool fit_straight(roadpose_heading_t *instance, const int32_t *along_q16, outcome_t *out) {
    out->focus.noise_q22 = noise_q22(instance, START_FOCUS_PERCENT);
    if (!roadpose_fit_rounds(instance, &out->focus, ROADPOSE_UNKNOWNS_FOCUS, COARSE_FOCUS)) {
        return false;
    }
    out->motion = out->focus;
    if (!roadpose_fit_round(instance, &out->motion, ROADPOSE_UNKNOWNS_MOTION, 1)) {
        return false;
    }
    judge(instance, along_q16, out);
    roadpose_fit_focus_alone(instance, &out->focus);
    out->chance_q8 = chance_q8(instance);
    out->agreeing = instance->round.agreeing;
    out->left_q16 = 65536;
    out->chosen = out->focus;
    return true;
}

/* A turn that no deviation brings back below the limit: there will be no yaw, and so no need of a last round. */
static bool is_sharp(const outcome_t *out) {
    const int64_t sure_q24 = SURE * 4 * (int64_t)out->rate_deviation;
    return roadpose_abs(left_turn_q24(out->motion.motion.turn_q24, out->normal_q30)) - sure_q24 > out->turn_max_q24;
}

/* The free fit to its end. If its rotation is significant, it is chosen, the rotation shrunk by what chance explains of it
 * (James and Stein's estimator, positive part). */
static bool fit_turned(roadpose_heading_t *instance, const int32_t *along_q16, outcome_t *out) {
    const int32_t noise = out->motion.noise_q22;
    if (!roadpose_fit_round(instance, &out->motion, ROADPOSE_UNKNOWNS_MOTION, 1)) {
        return false;
    }
    const int32_t cost = instance->round.cost_q8;
    out->chance_q8 = chance_q8(instance);
    judge(instance, along_q16, out);
    if (is_sharp(out)) {
        out->chosen = out->motion;
        out->agreeing = instance->round.agreeing;
        return true;
    }
    if (out->significance_q8 <= out->chance_q8 ||
        (!out->turned && cost_at(instance, &out->focus, noise) - cost <= SAVING_Q8)) {
        return conclude(instance, along_q16, out);
    }
    out->left_q16 = (int32_t)(INT64_C(65536) * out->chance_q8 / out->significance_q8);
    shrink(&instance->round.factors, out);
    return conclude(instance, along_q16, out);
}

/* Fits, choice, and what they leave open. False: the tracks do not tell one focus. */
static bool solve(roadpose_heading_t *instance, bool rate_known, outcome_t *out) {
    uint32_t random = instance->settings.seed;
    int32_t along_q16[ROADPOSE_UNKNOWNS_MOTION];
    yaw_direction(out->normal_q30, along_q16);
    roadpose_voters_choose(instance, out->focus.motion.turn_q24);
    if (roadpose_focus_search(instance, PAIRS, &random, &out->focus.motion) == 0 ||
        !fit_straight(instance, along_q16, out)) {
        return false;
    }
    const bool clear = out->significance_q8 <= out->chance_q8 &&
                       out->agreeing * 100u >= instance->flows_moving * CLEAR_PERCENT;
    out->turned = !rate_known && !clear && find_turn(instance, &random, out);
    if (!out->turned && out->significance_q8 * LOOK_CLOSER <= out->chance_q8) {
        return conclude(instance, along_q16, out);
    }
    return fit_turned(instance, along_q16, out);
}

/* Standard deviation of the yaw: of the chosen fit; where a rotation was seen, also what that rotation leaves open, and
 * what the shrinking moved. Each below 2^22; squares below 2^44. */
static int32_t sigma_urad(const outcome_t *out) {
    const int64_t own = out->deviation;
    int64_t square = own * own;
    if (out->left_q16 < 65536) {
        const int64_t unheld = out->free_deviation;
        const int64_t moved_urad = (int64_t)roadpose_yaw_angle(out->motion.motion.focus_q24, out->normal_q30) -
                                   roadpose_yaw_angle(out->chosen.motion.focus_q24, out->normal_q30);
        const int64_t moved = moved_urad * (INT64_C(1) << 22) / MICRO;
        square = ((unheld * unheld > square) ? unheld * unheld : square) + moved * moved;
    }
    return roadpose_clamp32(urad_of_q22((int64_t)roadpose_sqrt((uint64_t)square)));
}

/* Figures that are told whatever the status. */
static void report(const roadpose_heading_t *instance, const roadpose_motion_t *motion, const outcome_t *out,
                   roadpose_yaw_t *yaw) {
    const roadpose_lens_t *lens = &instance->lens;
    const int64_t noise_millipx = (int64_t)out->chosen.noise_q22 * 1000 / lens->px_q22;
    yaw->noise_millipx = (uint16_t)roadpose_clamp(noise_millipx, 0, UINT16_MAX);
    yaw->tracks_agreeing = out->agreeing;
    /* focus * f: 2^24 * 2^22 millipx; q24 millipx to q8 px */
    yaw->focus_u_q8 =
        lens->cu_q8 + (int32_t)((int64_t)out->chosen.motion.focus_q24[0] * lens->focal_millipx / 65536000);
    yaw->focus_v_q8 =
        lens->cv_q8 + (int32_t)((int64_t)out->chosen.motion.focus_q24[1] * lens->focal_millipx / 65536000);
    yaw->yaw_rate_urad_s = rate_urad_s(left_turn_q24(out->motion.motion.turn_q24, out->normal_q30), motion->interval_us);
    yaw->yaw_rate_sigma_urad_s = rate_urad_s((int64_t)out->rate_deviation * 4, motion->interval_us);
}

static bool agree_enough(const roadpose_heading_t *instance, const roadpose_yaw_t *yaw) {
    const uint32_t share = instance->settings.share_min_permille;
    return yaw->tracks_agreeing >= instance->settings.tracks_min &&
           (uint32_t)yaw->tracks_agreeing * 1000u >= share * yaw->tracks_moving;
}

/* From tracks alone: they tell the yaw rate too badly, or a turn explains them about as well, or a turn was found but too
 * few tracks agree with it, or they are loose enough to be a false focus. */
static bool is_ambiguous(const roadpose_heading_t *instance, const roadpose_motion_t *motion, const outcome_t *out,
                         const roadpose_yaw_t *yaw) {
    const roadpose_heading_settings_t *s = &instance->settings;
    const int32_t rival = rate_urad_s(left_turn_q24(out->rival_q24, out->normal_q30), motion->interval_us);
    return yaw->yaw_rate_sigma_urad_s > s->rate_sigma_max_urad_s || roadpose_abs(rival) > s->yaw_rate_max_urad_s ||
           (out->turned && yaw->tracks_agreeing * 100u < yaw->tracks_moving * TURNED_PERCENT) ||
           yaw->noise_millipx * 100 > s->noise_max_millipx * UNTOLD_NOISE_PERCENT;
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
    if (!unseen && rate + (rate_known ? -2 * unsure : SURE * unsure) > s->yaw_rate_max_urad_s) {
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
    if (!rate_known && is_ambiguous(instance, motion, out, yaw)) {
        return ROADPOSE_YAW_AMBIGUOUS;
    }
    const bool open = !rate_known && urad_of_q22(out->free_deviation) > 2 * (int64_t)s->sigma_max_urad;
    return (open || sigma > s->sigma_max_urad) ? ROADPOSE_YAW_UNCERTAIN : ROADPOSE_YAW_OK;
}

static void fill_angles(roadpose_heading_t *instance, const outcome_t *out, int32_t sigma, roadpose_yaw_t *yaw) {
    const int32_t *normal_q30 = out->normal_q30;
    const int32_t *focus = out->chosen.motion.focus_q24;
    const int32_t angle = roadpose_yaw_angle(focus, normal_q30);
    if (roadpose_abs(angle) > instance->settings.yaw_max_urad) {
        yaw->status = ROADPOSE_YAW_OUTSIDE_LIMITS;
        return;
    }
    instance->free_urad = roadpose_yaw_angle(out->motion.motion.focus_q24, out->normal_q30) - angle;
    yaw->yaw_urad = angle;
    yaw->sigma_urad = sigma;
    yaw->pitch_difference_urad = roadpose_descent(focus, normal_q30);
    yaw->pitch_motion_urad = roadpose_pitch_of_normal(normal_q30) - yaw->pitch_difference_urad;
}

void roadpose_heading_estimate(roadpose_heading_t *instance, const roadpose_motion_t *motion, const int32_t *normal_q30,
                               roadpose_yaw_t *yaw) {
    static const int32_t DOWN_Q30[3] = {0, INT32_C(1) << 30, 0};
    const int32_t *normal = (normal_q30 != NULL) ? normal_q30 : DOWN_Q30;
    const int64_t turn_max_urad = (int64_t)instance->settings.yaw_rate_max_urad_s * motion->interval_us / MICRO;
    outcome_t out = {.normal_q30 = normal, .turn_max_q24 = q24_of_urad(turn_max_urad)};
    yaw->status = vehicle_gate(instance, motion);
    if (yaw->status == ROADPOSE_YAW_OK) {
        yaw->status = track_gate(instance, yaw);
    }
    if (yaw->status != ROADPOSE_YAW_OK) {
        return;
    }
    turn_about_normal(vehicle_turn_q24(motion), normal, out.focus.motion.turn_q24);
    if (!solve(instance, motion->has_yaw_rate, &out)) {
        yaw->status = ROADPOSE_YAW_NO_FOCUS;
        return;
    }
    report(instance, motion, &out, yaw);
    const int32_t sigma = sigma_urad(&out);
    yaw->status = fit_gate(instance, motion, &out, sigma, yaw);
    if (yaw->status == ROADPOSE_YAW_OK && normal_q30 == NULL) {
        yaw->status = ROADPOSE_YAW_NO_ROAD;
    }
    if (yaw->status == ROADPOSE_YAW_OK) {
        fill_angles(instance, &out, sigma, yaw);
    }
}
