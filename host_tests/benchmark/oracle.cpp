#include "oracle.hpp"

#include <cmath>

#include "roadpose/roadpose.h"

namespace benchmark {
namespace {

struct RoadPixel {
    double x, y, disparity;  // x, y from the principal point
};

// Sideways is along the road, from the point straight below the camera.
bool in_corridor(double x, double true_disparity, const DisparityPlane& truth, const recording_rig_t& rig) {
    roadpose_settings_t settings;
    roadpose_settings_default(&settings);
    const double length = std::hypot(truth.a, truth.b, truth.c / rig.focal_px), n_x = truth.a / length;
    const double camera_x = x * rig.baseline_m / true_disparity, below = n_x * rig.baseline_m / length;
    const double sideways_mm = 1000 * std::abs(camera_x - below) / std::sqrt(1 - n_x * n_x);
    const double ahead_mm = 1000 * rig.focal_px * rig.baseline_m / true_disparity;
    return sideways_mm <= settings.corridor_half_width_mm && ahead_mm <= settings.corridor_range_mm;
}

// The corridor is cut with the true plane, so that noise cannot select what is inside.
std::vector<RoadPixel> road_pixels(const Frame& frame, bool corridor) {
    const recording_rig_t& rig = *frame.rig;
    const DisparityPlane truth = plane_of({frame.truth.pitch_deg, frame.truth.roll_deg, frame.truth.height_m}, rig);
    std::vector<RoadPixel> pixels;
    for (int v = 0; v < rig.height; ++v)
        for (int u = 0; u < rig.width; ++u) {
            if (!frame.road[static_cast<std::size_t>(v) * rig.width + u]) continue;
            const RoadPixel pixel{u - rig.cu_px, v - rig.cv_px, frame.disparity(u, v)};
            if (pixel.disparity > 0 && (!corridor || in_corridor(pixel.x, truth.at(pixel.x, pixel.y), truth, rig)))
                pixels.push_back(pixel);
        }
    return pixels;
}

struct Moments {
    double n = 0, x = 0, y = 0, d = 0, xx = 0, xy = 0, yy = 0, xd = 0, yd = 0;
    void add(const RoadPixel& p) {
        n += 1, x += p.x, y += p.y, d += p.disparity;
        xx += p.x * p.x, xy += p.x * p.y, yy += p.y * p.y, xd += p.x * p.disparity, yd += p.y * p.disparity;
    }
};

DisparityPlane solve(const Moments& m) {
    const double xx = m.xx - m.x * m.x / m.n, xy = m.xy - m.x * m.y / m.n, yy = m.yy - m.y * m.y / m.n;
    const double xd = m.xd - m.x * m.d / m.n, yd = m.yd - m.y * m.d / m.n;
    const double determinant = xx * yy - xy * xy;
    const double a = (xd * yy - yd * xy) / determinant, b = (yd * xx - xd * xy) / determinant;
    return {a, b, (m.d - a * m.x - b * m.y) / m.n};
}

DisparityPlane fit(const std::vector<RoadPixel>& pixels) {
    Moments moments;
    for (const RoadPixel& pixel : pixels) moments.add(pixel);
    return solve(moments);
}

DisparityPlane fit_again(const std::vector<RoadPixel>& pixels, const DisparityPlane& plane, double band_px) {
    Moments moments;
    for (const RoadPixel& pixel : pixels)
        if (std::abs(pixel.disparity - plane.at(pixel.x, pixel.y)) <= band_px) moments.add(pixel);
    return solve(moments);
}

}  // namespace

std::optional<Pose> fit_true_road(const Frame& frame, const OracleOptions& options) {
    if (frame.road.empty() || !frame.truth.road) return std::nullopt;
    const std::vector<RoadPixel> pixels = road_pixels(frame, options.corridor);
    if (pixels.size() < 100) return std::nullopt;
    DisparityPlane plane = fit(pixels);
    roadpose_settings_t settings;
    roadpose_settings_default(&settings);
    for (int round = 0; options.trimmed && round < 2; ++round)
        plane = fit_again(pixels, plane, 0.001 * settings.noise_millipx);
    return pose_of(plane, *frame.rig);
}

}  // namespace benchmark
