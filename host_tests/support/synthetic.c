#include "synthetic.h"

#include <math.h>
#include <string.h>

static const double degree = 3.14159265358979323846 / 180;

true_plane_t true_plane_of(const roadpose_rig_t *rig, true_pose_t pose) {
    const double pitch = pose.pitch_deg * degree, roll = pose.roll_deg * degree;
    const double scale = rig->baseline_um * 1e-6 / pose.height_m;
    const true_plane_t plane = {scale * cos(pitch) * sin(roll), scale * cos(pitch) * cos(roll),
                                scale * sin(pitch) * rig->focal_millipx * 1e-3};
    return plane;
}

true_pose_t true_pose_of(const roadpose_rig_t *rig, true_plane_t plane) {
    const double z = plane.c / (rig->focal_millipx * 1e-3);
    const double length = sqrt(plane.a * plane.a + plane.b * plane.b + z * z);
    const true_pose_t pose = {asin(z / length) / degree, atan2(plane.a, plane.b) / degree,
                              rig->baseline_um * 1e-6 / length};
    return pose;
}

double true_disparity_at(const roadpose_rig_t *rig, true_plane_t plane, double u, double v) {
    return plane.a * (u - rig->cu_millipx * 1e-3) + plane.b * (v - rig->cv_millipx * 1e-3) + plane.c;
}

void render_road(const roadpose_rig_t *rig, true_pose_t pose, int disparity_limit_px, uint16_t *samples) {
    const true_plane_t plane = true_plane_of(rig, pose);
    for (int v = 0; v < rig->height_px; v++)
        for (int u = 0; u < rig->width_px; u++) {
            const double q8 = floor(256 * true_disparity_at(rig, plane, u, v) + 0.5);
            *samples++ = (uint16_t)(q8 > 0 && q8 < 256.0 * disparity_limit_px && q8 < 65536 ? q8 : 0);
        }
}

void render_wall(const roadpose_rig_t *rig, true_pose_t pose, double disparity_px, int from, int to, int rows_high,
                 uint16_t *samples) {
    const true_plane_t plane = true_plane_of(rig, pose);
    for (int v = 0; v < rig->height_px; v++)
        for (int u = from; u < to && u < rig->width_px; u++)
            if (true_disparity_at(rig, plane, u, v) < disparity_px &&
                true_disparity_at(rig, plane, u, v + rows_high) >= disparity_px)
                samples[(size_t)v * rig->width_px + (size_t)u] = (uint16_t)(256 * disparity_px);
}

roadpose_rig_t rig_640x480(void) {
    const roadpose_rig_t rig = {640, 480, 500000, 319500, 239500, 300000};
    return rig;
}

roadpose_disparity_format_t format_u16_q8(void) {
    roadpose_disparity_format_t format;
    (void)roadpose_format_preset(&format, ROADPOSE_FORMAT_U16_Q8);
    return format;
}

roadpose_frame_t frame_of(const roadpose_rig_t *rig, const void *samples) {
    roadpose_frame_t frame;
    memset(&frame, 0, sizeof frame);
    frame.samples = samples;
    frame.stride_bytes = 2u * rig->width_px;
    frame.width_px = rig->width_px;
    frame.height_px = rig->height_px;
    return frame;
}
