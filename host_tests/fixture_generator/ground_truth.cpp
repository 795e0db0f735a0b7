#include "ground_truth.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "disparity_samples.hpp"

namespace fixtures {
namespace {

constexpr double corridor_half_width = 2.0, corridor_near = 3.0, corridor_far = 25.0;

// z = p₀·x + p₁·y + p₂ in the least-squares sense, summed about the caller's own centre to keep the digits.
class PlaneSums {
public:
    void add(double x, double y, double z) {
        const cv::Vec3d row(x, y, 1.0);
        left_ += row * row.t();
        right_ += row * z;
    }
    cv::Vec3d solve() const { return left_.solve(right_, cv::DECOMP_LU); }

private:
    cv::Matx33d left_ = cv::Matx33d::zeros();
    cv::Vec3d right_{0, 0, 0};
};

// d = a·(u−u0) + b·(v−v0) + c
struct DisparityPlane {
    double a, b, c;
    double at(double u, double v) const { return a * u + b * v + c; }
};

DisparityPlane to_disparity(const RoadPlane& plane, const Rig& rig) {
    const double scale = rig.baseline_m / plane.height;
    return {scale * plane.normal[0], scale * plane.normal[1], scale * plane.normal[2] * rig.focal_px};
}

RoadPlane to_road_plane(const DisparityPlane& plane, const Rig& rig) {
    const cv::Vec3d n(plane.a, plane.b, plane.c / rig.focal_px);
    return {n / cv::norm(n), rig.baseline_m / cv::norm(n)};
}

struct RoadPixel {
    double u, v;  // from the principal point
    double exact, matched;
};

bool in_corridor(const RoadPixel& pixel, const Rig& rig) {
    const double depth = rig.focal_px * rig.baseline_m / pixel.exact;
    const double sideways = pixel.u * depth / rig.focal_px;
    return depth >= corridor_near && depth <= corridor_far && std::abs(sideways) <= corridor_half_width;
}

std::vector<RoadPixel> road_pixels(const StereoPair& pair, const cv::Mat& disparity, const Rig& rig, bool corridor_only) {
    std::vector<RoadPixel> pixels;
    for (int row = 0; row < rig.height; ++row)
        for (int column = 0; column < rig.width; ++column) {
            if (!pair.road.at<std::uint8_t>(row, column)) continue;
            const RoadPixel pixel{column - rig.cu_px, row - rig.cv_px, pair.exact_disparity.at<double>(row, column),
                                  disparity.at<std::uint16_t>(row, column) / static_cast<double>(disparity_scale)};
            if (!corridor_only || in_corridor(pixel, rig)) pixels.push_back(pixel);
        }
    return pixels;
}

PoseError difference(const RoadPlane& measured, const RoadPlane& truth) {
    return {degrees(measured.pitch() - truth.pitch()), degrees(measured.roll() - truth.roll()),
            1000.0 * (measured.height - truth.height)};
}

PoseError fit_exact(const std::vector<RoadPixel>& pixels, const Rig& rig, const RoadPlane& truth) {
    PlaneSums sums;
    for (const RoadPixel& pixel : pixels) sums.add(pixel.u, pixel.v, pixel.exact);
    const cv::Vec3d p = sums.solve();
    return difference(to_road_plane({p[0], p[1], p[2]}, rig), truth);
}

PoseError fit_matched(const std::vector<RoadPixel>& pixels, const Rig& rig, const RoadPlane& truth) {
    DisparityPlane plane = to_disparity(truth, rig);
    for (const double band : {1.5, 0.6, 0.35}) {
        PlaneSums sums;
        for (const RoadPixel& pixel : pixels)
            if (pixel.matched > 0 && std::abs(pixel.matched - plane.at(pixel.u, pixel.v)) < band)
                sums.add(pixel.u, pixel.v, pixel.matched);
        const cv::Vec3d p = sums.solve();
        plane = {p[0], p[1], p[2]};
    }
    return difference(to_road_plane(plane, rig), truth);
}

double median(std::vector<double> values) {
    if (values.empty()) return 0.0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

void measure_matches(const std::vector<RoadPixel>& pixels, FrameCheck& check) {
    std::vector<double> errors;
    int outliers = 0;
    for (const RoadPixel& pixel : pixels) {
        if (pixel.matched <= 0) continue;
        errors.push_back(pixel.matched - pixel.exact);
        outliers += std::abs(errors.back()) > 1.0;
    }
    check.road_pixels = static_cast<int>(pixels.size());
    check.valid_share = static_cast<double>(errors.size()) / std::max<std::size_t>(pixels.size(), 1);
    check.outlier_share = static_cast<double>(outliers) / std::max<std::size_t>(errors.size(), 1);
    check.bias_px = median(errors);
    for (double& error : errors) error = std::abs(error - check.bias_px);
    check.noise_px = 1.4826 * median(errors);
}

RoadPlane plane_of_crown(const RoadSurface& road, const Pose& pose) {
    const double c = std::cos(pose.yaw), s = std::sin(pose.yaw);
    PlaneSums sums;
    for (int i = 0; i <= 220; ++i)
        for (int j = -20; j <= 20; ++j) {
            const double ahead = corridor_near + 0.1 * i, left = 0.1 * j;
            const double x = pose.position[0] + c * ahead - s * left, y = pose.position[1] + s * ahead + c * left;
            sums.add(x - pose.position[0], y - pose.position[1], road.elevation(x, y));
        }
    const cv::Vec3d p = sums.solve();
    const cv::Vec3d down(p[0], p[1], -1.0);  // points into the road
    const double length = cv::norm(down);
    return {camera_to_world(pose).t() * (down / length), (pose.position[2] - p[2]) / length};
}

}  // namespace

RoadPlane true_road_plane(const RoadSurface& road, const Pose& pose) {
    if (road.crown != 0.0) return plane_of_crown(road, pose);
    return {camera_to_world(pose).t() * cv::Vec3d(0, 0, -1), pose.position[2]};
}

FrameCheck check_frame(const StereoPair& pair, const cv::Mat& disparity, const Rig& rig, const RoadPlane& truth,
                       bool corridor_only) {
    const std::vector<RoadPixel> pixels = road_pixels(pair, disparity, rig, corridor_only);
    FrameCheck check;
    measure_matches(pixels, check);
    check.exact_fit = fit_exact(pixels, rig, truth);
    check.matched_fit = fit_matched(pixels, rig, truth);
    return check;
}

std::string header_of_check() {
    return "road_px valid% bias_px noise_px outlier% | exact LS: pitch_deg roll_deg height_mm | "
           "matched LS: pitch_deg roll_deg height_mm";
}

std::string to_text(const FrameCheck& check) {
    char text[200];
    const PoseError &e = check.exact_fit, &m = check.matched_fit;
    std::snprintf(text, sizeof text, "%6d %5.1f %+.4f %.3f %5.2f | %+.1e %+.1e %+.1e | %+.4f %+.4f %+.2f", check.road_pixels,
                  100 * check.valid_share, check.bias_px, check.noise_px, 100 * check.outlier_share, e.pitch_deg,
                  e.roll_deg, e.height_mm, m.pitch_deg, m.roll_deg, m.height_mm);
    return text;
}

}  // namespace fixtures
