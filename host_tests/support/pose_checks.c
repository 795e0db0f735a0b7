#include "pose_checks.h"

#include <math.h>
#include <string.h>

static bool same_axes(const roadpose_pose_t *left, const roadpose_pose_t *right) {
    return left->pitch_urad == right->pitch_urad && left->roll_urad == right->roll_urad &&
           left->height_um == right->height_um && left->paper_pitch_urad == right->paper_pitch_urad &&
           left->paper_roll_urad == right->paper_roll_urad && left->plane_u_q24 == right->plane_u_q24 &&
           left->plane_v_q24 == right->plane_v_q24 && left->plane_0_q16 == right->plane_0_q16 &&
           memcmp(left->normal_q30, right->normal_q30, sizeof left->normal_q30) == 0;
}

bool same_pose(const roadpose_pose_t *left, const roadpose_pose_t *right) {
    return left->status == right->status && left->observed == right->observed && same_axes(left, right) &&
           left->valid_samples == right->valid_samples && left->free_samples == right->free_samples &&
           left->road_points == right->road_points && left->support_permille == right->support_permille &&
           left->residual_millipx == right->residual_millipx && left->range_near_mm == right->range_near_mm &&
           left->range_far_mm == right->range_far_mm;
}

static bool has_no_axes(const roadpose_pose_t *pose) {
    roadpose_pose_t nothing;
    memset(&nothing, 0, sizeof nothing);
    return pose->observed == 0 && same_axes(pose, &nothing);
}

static double normal_length(const roadpose_pose_t *pose) {
    double sum = 0;
    for (int i = 0; i < 3; i++) sum += ldexp(pose->normal_q30[i], -30) * ldexp(pose->normal_q30[i], -30);
    return sqrt(sum);
}

static const char *axes_fault(const roadpose_pose_t *pose, const roadpose_settings_t *settings) {
    const unsigned always = ROADPOSE_OBSERVED_PITCH | ROADPOSE_OBSERVED_HEIGHT;
    if ((pose->observed & always) != always || pose->observed > 7) return "accepted without pitch or height";
    if (!(pose->observed & ROADPOSE_OBSERVED_ROLL) && pose->roll_urad) return "a roll that was not observed is not 0";
    if (pose->pitch_urad < settings->pitch_min_urad || pose->pitch_urad > settings->pitch_max_urad ||
        pose->roll_urad < -settings->roll_max_urad || pose->roll_urad > settings->roll_max_urad ||
        pose->height_um < settings->height_min_um || pose->height_um > settings->height_max_um)
        return "accepted outside the mounting limits";
    return fabs(normal_length(pose) - 1) > 1e-5 ? "the normal is no unit vector" : NULL;
}

static const char *support_fault(const roadpose_pose_t *pose, const roadpose_settings_t *settings) {
    if (pose->road_points < settings->points_min) return "accepted with too few points";
    if (pose->support_permille < settings->support_min_permille) return "accepted with too little support";
    if ((int64_t)pose->range_far_mm < settings->range_min_mm) return "accepted with too short a range";
    return pose->range_near_mm > pose->range_far_mm ? "the nearest road is farther than the farthest" : NULL;
}

const char *pose_fault(const roadpose_pose_t *pose, const roadpose_settings_t *settings) {
    if (pose->status >= ROADPOSE_STATUS_COUNT) return "no such status";
    if (pose->free_samples > pose->valid_samples) return "more free than valid samples";
    if (pose->road_points > pose->free_samples) return "more road points than free samples";
    if (pose->support_permille > 1000) return "support over 1000 permille";
    if (pose->status != ROADPOSE_STATUS_OK) return has_no_axes(pose) ? NULL : "a refused frame has a pose";
    const char *fault = axes_fault(pose, settings);
    return fault ? fault : support_fault(pose, settings);
}
