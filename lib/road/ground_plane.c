#include "road/ground_plane.h"

#include "fixed_point/fixed_point.h"

/* Proved range of a pixel plane: |a|, |b| < 8 px per px, |c| < 2^15 px. */
#define SLOPE_LIMIT_Q24 (INT64_C(1) << 27)
#define OFFSET_LIMIT_Q24 (INT64_C(1) << 39)

/* sin 35 deg = 0.574, tan 35 deg = 0.700: largest settings; candidates may pass them by a tenth. */
#define ONE_Q16 65536

bool roadpose_plane_to_pixels(const roadpose_plane_t *plane, const roadpose_grid_t *grid, roadpose_pixel_plane_t *out) {
    const int64_t a = plane->a_q24 / ROADPOSE_COLUMN_STEP;
    const int64_t b = plane->b_q24 / ROADPOSE_ROW_STEP;
    if (roadpose_abs(a) >= SLOPE_LIMIT_Q24 || roadpose_abs(b) >= SLOPE_LIMIT_Q24 ||
        plane->c_q24 >= OFFSET_LIMIT_Q24 || plane->c_q24 <= -OFFSET_LIMIT_Q24) {
        return false;
    }
    out->a_q24 = (int32_t)a;
    out->b_q24 = (int32_t)b;
    /* the grid's centre is du, dv off the principal point: |du| <= 8000, |a * du| < 2^27 * 2^13 */
    out->c_q24 = plane->c_q24 - (a * grid->du_millipx + b * grid->dv_millipx) / 1000;
    const int64_t c_over_f = roadpose_ratio(out->c_q24, grid->focal_millipx, 10) * 1000 / 1024;
    /* |c / f| < 2^39 / 50 < 2^34 could square to 2^68: what is steeper than 8 is no road */
    if (roadpose_abs(c_over_f) >= SLOPE_LIMIT_Q24) {
        return false;
    }
    /* three squares below 2^54 each */
    out->length_q24 = (int64_t)roadpose_sqrt((uint64_t)(a * a + b * b + c_over_f * c_over_f));
    return out->length_q24 > 0;
}

static void plane_normal(const roadpose_pixel_plane_t *plane, const roadpose_grid_t *grid, int32_t normal_q30[3]) {
    const int64_t c_over_f = roadpose_ratio(plane->c_q24, grid->focal_millipx, 10) * 1000 / 1024;
    const int64_t part[3] = {plane->a_q24, plane->b_q24, c_over_f};
    for (int i = 0; i < 3; i++) {
        /* |part| <= length up to the root's rounding, so the ratio is within 2^30 but for one LSB: clamp that */
        const int64_t q30 = roadpose_ratio(part[i], plane->length_q24, 30);
        normal_q30[i] = (int32_t)roadpose_clamp(q30, -(INT64_C(1) << 30), INT64_C(1) << 30);
    }
}

/* sqrt(x^2 + y^2) of two Q30 parts of a unit vector: below 2^60 + 2^60. */
static int32_t hypotenuse_q30(int32_t x, int32_t y) {
    const uint32_t root = roadpose_sqrt((uint64_t)((int64_t)x * x + (int64_t)y * y));
    return (int32_t)((root > (UINT32_C(1) << 30)) ? (UINT32_C(1) << 30) : root);
}

void roadpose_plane_pose(const roadpose_pixel_plane_t *plane, const roadpose_grid_t *grid, roadpose_pose_t *pose) {
    int32_t *n = pose->normal_q30;
    plane_normal(plane, grid, n);
    pose->pitch_urad = roadpose_arctangent(n[2], hypotenuse_q30(n[0], n[1]));
    pose->roll_urad = roadpose_arctangent(n[0], n[1]);
    pose->paper_pitch_urad = roadpose_arctangent(n[2], n[1]);
    pose->paper_roll_urad = roadpose_arctangent(n[0], hypotenuse_q30(n[1], n[2]));
    /* baseline <= 2e6 um, length >= 1: ratio saturates, then the clamp holds */
    pose->height_um = roadpose_clamp32(roadpose_ratio(grid->baseline_um, plane->length_q24, 24));
    pose->plane_u_q24 = plane->a_q24;
    pose->plane_v_q24 = plane->b_q24;
    pose->plane_0_q16 = roadpose_clamp32(roadpose_floor_shift(plane->c_q24, 8));
}

bool roadpose_pose_within_limits(const roadpose_pose_t *pose, const roadpose_settings_t *settings) {
    const bool pitch = pose->pitch_urad >= settings->pitch_min_urad && pose->pitch_urad <= settings->pitch_max_urad;
    const bool roll = pose->roll_urad >= -settings->roll_max_urad && pose->roll_urad <= settings->roll_max_urad;
    const bool height = pose->height_um >= settings->height_min_um && pose->height_um <= settings->height_max_um;
    return pitch && roll && height;
}

/* tan(angle) in Q16 for |angle| <= 0.61 rad, an upper bound of its size that is at most 4 % too large:
 * x + x^3 / 3 + x^5 / 5, whose terms stay below 1; x in Q16. */
static int64_t tangent_bound_q16(int32_t angle_urad) {
    const int64_t x = (int64_t)angle_urad * ONE_Q16 / 1000000;
    const int64_t x2 = x * x / ONE_Q16;
    const int64_t x3 = x2 * x / ONE_Q16;
    const int64_t x5 = x3 * x2 / ONE_Q16;
    return x + x3 / 3 + x5 / 5;
}

void roadpose_plane_box(roadpose_plane_box_t *box, const roadpose_grid_t *grid, const roadpose_settings_t *settings) {
    /* b = B n_y / h per pixel row, n_y in cos 35 deg * cos 30 deg = 0.70 ... 1; a tenth of room on either side */
    const int64_t low = (int64_t)grid->baseline_um * ROADPOSE_ROW_STEP * 63 / 100;
    const int64_t high = (int64_t)grid->baseline_um * ROADPOSE_ROW_STEP * 110 / 100;
    box->b_min_q24 = roadpose_clamp32(roadpose_ratio(low, settings->height_max_um, 24));
    box->b_max_q24 = roadpose_clamp32(roadpose_ratio(high, settings->height_min_um, 24));
    /* c / b = f n_z / n_y = f tan(paper pitch); |tan(paper pitch)| <= tan(pitch) / cos(roll), 1 / cos 35 deg = 1.22.
     * In grid rows: f <= 4000 px, so below 2^12 * 2^16 * 1.3 */
    const int64_t focal_rows = grid->focal_millipx / ROADPOSE_ROW_STEP;
    const int64_t slack = focal_rows * ONE_Q16 / 50 / 1000; /* 0.02 rad: a candidate is rough */
    box->c_min_rows_q16 = focal_rows * tangent_bound_q16(settings->pitch_min_urad) * 125 / 100000 - slack;
    box->c_max_rows_q16 = focal_rows * tangent_bound_q16(settings->pitch_max_urad) * 125 / 100000 + slack;
    /* a / b = n_x / n_y = tan(roll), in grid rows per grid column */
    const int64_t slope = tangent_bound_q16(settings->roll_max_urad) * 110 / 100 + ONE_Q16 / 50;
    box->slope_max_q16 = roadpose_clamp32(slope * ROADPOSE_COLUMN_STEP / ROADPOSE_ROW_STEP);
}

bool roadpose_profile_in_box(const roadpose_plane_t *plane, const roadpose_plane_box_t *box) {
    if (plane->b_q24 < box->b_min_q24 || plane->b_q24 > box->b_max_q24) {
        return false;
    }
    const int64_t rows_q16 = roadpose_ratio(plane->c_q24, plane->b_q24, 16);
    return rows_q16 >= box->c_min_rows_q16 && rows_q16 <= box->c_max_rows_q16;
}
