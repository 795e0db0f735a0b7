#include "plane_peer.hpp"

#include <cmath>

#include "corridor.hpp"
#include "random_numbers.hpp"

namespace evaluation {
namespace {

constexpr int hypotheses_max = 1000;
constexpr double sureness = 0.999;

struct Point {
    double x, y, disparity;
};

std::vector<Point> points_of(const Input& input, const PlaneRansacOptions& options) {
    const recording_rig_t& rig = input.rig();
    std::vector<Point> points;
    for (int v = 0; v < rig.height; v += options.sparse ? 2 : 1)
        for (int u = 0; u < rig.width; u += options.sparse ? 4 : 1) {
            const Point point{u - rig.cu_px, v - rig.cv_px, input.disparity(v, u)};
            if (point.disparity > 0 && (!options.cropped || is_in_crop(rig, point.x, point.disparity))) points.push_back(point);
        }
    return points;
}

std::optional<DisparityPlane> through(const Point& p, const Point& q, const Point& r) {
    const double x1 = q.x - p.x, y1 = q.y - p.y, d1 = q.disparity - p.disparity;
    const double x2 = r.x - p.x, y2 = r.y - p.y, d2 = r.disparity - p.disparity;
    const double determinant = x1 * y2 - x2 * y1;
    if (std::abs(determinant) < 1) return std::nullopt;
    const double a = (d1 * y2 - d2 * y1) / determinant, b = (x1 * d2 - x2 * d1) / determinant;
    return DisparityPlane{a, b, p.disparity - a * p.x - b * p.y};
}

bool is_near(const Point& point, const DisparityPlane& plane, double band) {
    return std::abs(point.disparity - plane.at(point.x, point.y)) <= band;
}

// How many hypotheses make it sure enough that one of them was drawn from inliers only.
double hypotheses_needed(double inlier_share) {
    const double all_good = inlier_share * inlier_share * inlier_share;
    return all_good >= 1 ? 1 : std::log(1 - sureness) / std::log(1 - all_good);
}

std::optional<DisparityPlane> ransac(const std::vector<Point>& points, double band, const recording_rig_t& rig) {
    Random random(1);
    std::optional<DisparityPlane> best;
    std::ptrdiff_t best_support = 0;
    double needed = hypotheses_max;
    for (int tried = 0; tried < hypotheses_max && tried < needed; ++tried) {
        const auto draw = [&]() -> const Point& { return points[random.below(points.size())]; };
        const std::optional<DisparityPlane> plane = through(draw(), draw(), draw());
        if (!plane || !is_within_limits(benchmark::pose_of(*plane, rig))) continue;
        const auto support = std::count_if(points.begin(), points.end(),
                                           [&](const Point& point) { return is_near(point, *plane, band); });
        if (support <= best_support) continue;
        best = plane, best_support = support;
        needed = hypotheses_needed(static_cast<double>(support) / static_cast<double>(points.size()));
    }
    return best;
}

DisparityPlane least_squares(const std::vector<Point>& points, const DisparityPlane& start, double band) {
    cv::Matx33d normal = cv::Matx33d::zeros();
    cv::Vec3d right(0, 0, 0);
    for (const Point& point : points) {
        if (!is_near(point, start, band)) continue;
        const cv::Vec3d row(point.x, point.y, 1);
        normal += row * row.t();
        right += point.disparity * row;
    }
    const cv::Vec3d plane = normal.solve(right, cv::DECOMP_CHOLESKY);
    return {plane[0], plane[1], plane[2]};
}

}  // namespace

Answer plane_ransac_pose(const Input& input, const PlaneRansacOptions& options) {
    const std::vector<Point> points = points_of(input, options);
    if (points.size() < 100) return no_road();
    std::optional<DisparityPlane> plane = ransac(points, options.band_px, input.rig());
    for (int round = 0; plane && round < 3; ++round) plane = least_squares(points, *plane, options.band_px);
    return plane ? answer_of(*plane, input.rig()) : no_road();
}

}  // namespace evaluation
