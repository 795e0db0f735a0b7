#include "road/acceptance.h"

#include "disparity/ground_range.h"
#include "fixed_point/fixed_point.h"
#include "road/ground_plane.h"

/* The nearest and farthest road is where this share of the points lies nearer, or farther: a few stray points do not
 * stretch the range. */
#define RANGE_SHARE 64

/* The farthest road must be this many times as far as the nearest: over less, a ramp or the bed of a lorry joined to the
 * road passes for a plane. */
#define DEPTH_RATIO_MIN 2u

void roadpose_refuse(roadpose_pose_t *pose, roadpose_status_t status) {
    const roadpose_pose_t counts = *pose;
    *pose = (roadpose_pose_t){0};
    pose->status = (uint8_t)status;
    pose->valid_samples = counts.valid_samples;
    pose->free_samples = counts.free_samples;
    pose->road_points = counts.road_points;
    pose->support_permille = counts.support_permille;
    pose->residual_millipx = counts.residual_millipx;
    pose->range_near_mm = counts.range_near_mm;
    pose->range_far_mm = counts.range_far_mm;
}

static uint32_t road_at(const roadpose_moments_t *moments, int32_t level) {
    return moments->level[level].open ? moments->level[level].on : 0u;
}

/* Walks from one end of the levels until `share` points are passed, or to the other end. */
static int32_t level_after(const roadpose_moments_t *moments, int32_t first, int32_t last) {
    const int32_t step = (first < last) ? 1 : -1;
    const uint32_t share = moments->on_road / RANGE_SHARE + 1u;
    int32_t level = first;
    uint32_t passed = road_at(moments, level);
    while (passed < share && level != last) {
        level += step;
        passed += road_at(moments, level);
    }
    return level;
}

static void fill_support(roadpose_pose_t *pose, const roadpose_moments_t *moments, const roadpose_grid_t *grid) {
    const uint32_t all = moments->on_road + moments->uneven + moments->above + moments->below; /* <= ROADPOSE_MAX_POINTS */
    pose->road_points = moments->on_road;
    if (moments->on_road == 0u) {
        return;
    }
    pose->support_permille = (uint16_t)(moments->on_road * 1000u / all);
    /* mean square in Q16 px^2; residuals are below 4 px, so its root below 2^10 */
    const uint32_t root_q8 = roadpose_sqrt((uint64_t)(moments->rr / moments->n));
    pose->residual_millipx = (uint16_t)(root_q8 * 1000u / 256u);
    const int32_t far_level = level_after(moments, 0, ROADPOSE_MAX_DISPARITY - 1);
    const int32_t near_level = level_after(moments, ROADPOSE_MAX_DISPARITY - 1, 0);
    pose->range_far_mm = roadpose_range_mm_at(grid, far_level * 256 + 128);
    pose->range_near_mm = roadpose_range_mm_at(grid, near_level * 256 + 128);
}

static roadpose_status_t judge(const roadpose_pose_t *pose, const roadpose_settings_t *settings) {
    if (!roadpose_pose_within_limits(pose, settings)) {
        return ROADPOSE_STATUS_OUTSIDE_LIMITS;
    }
    if (pose->road_points < settings->points_min) {
        return ROADPOSE_STATUS_LITTLE_SUPPORT;
    }
    if (pose->support_permille < settings->support_min_permille) {
        return ROADPOSE_STATUS_POOR_FIT;
    }
    if (pose->range_far_mm < (uint32_t)settings->range_min_mm ||
        pose->range_far_mm / DEPTH_RATIO_MIN < pose->range_near_mm) {
        return ROADPOSE_STATUS_SHORT_RANGE;
    }
    return ROADPOSE_STATUS_OK;
}

void roadpose_accept(roadpose_pose_t *pose, const roadpose_plane_t *plane, const roadpose_moments_t *moments,
                     const roadpose_grid_t *grid, const roadpose_settings_t *settings, bool roll_observed) {
    roadpose_pixel_plane_t pixels;
    fill_support(pose, moments, grid);
    if (!roadpose_plane_to_pixels(plane, grid, &pixels)) {
        roadpose_refuse(pose, ROADPOSE_STATUS_OUTSIDE_LIMITS);
        return;
    }
    roadpose_plane_pose(&pixels, grid, pose);
    const roadpose_status_t status = judge(pose, settings);
    if (status != ROADPOSE_STATUS_OK) {
        roadpose_refuse(pose, status);
        return;
    }
    pose->status = (uint8_t)ROADPOSE_STATUS_OK;
    pose->observed = (uint8_t)(ROADPOSE_OBSERVED_PITCH | ROADPOSE_OBSERVED_HEIGHT);
    if (roll_observed) {
        pose->observed = (uint8_t)(pose->observed | ROADPOSE_OBSERVED_ROLL);
    } else {
        pose->roll_urad = 0;
        pose->paper_roll_urad = 0;
    }
}
