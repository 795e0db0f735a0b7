#include "plane_peer.hpp"

#include <cmath>

#include "random_numbers.hpp"

namespace evaluation {
namespace {

constexpr int hypotheses_max = 1000;
constexpr double sureness = 0.999;

struct Point {
    double x, y, disparity;
};

std::vector<Point> points_of(const Input& input, const Samples& samples, bool sparse) {
    const recording_rig_t& rig = input.rig();
    const SampleReader read = samples.reader();
    const int row_step = sparse ? 2 : 1, column_step = sparse ? 4 : 1;
    std::vector<Point> points;
    points.reserve(input.native.size() / static_cast<std::size_t>(row_step * column_step));
    for (int v = 0; v < rig.height; v += row_step) {
        const std::uint16_t* const row = &input.native[static_cast<std::size_t>(v) * rig.width];
        for (int u = 0; u < rig.width; u += column_step)
            if (read.keeps(u, row[u])) points.push_back({u - rig.cu_px, v - rig.cv_px, read.disparity(row[u])});
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
    double n = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0, d = 0, xd = 0, yd = 0;
    for (const Point& point : points) {
        if (!is_near(point, start, band)) continue;
        n += 1, x += point.x, y += point.y, d += point.disparity;
        xx += point.x * point.x, xy += point.x * point.y, yy += point.y * point.y;
        xd += point.x * point.disparity, yd += point.y * point.disparity;
    }
    const cv::Matx33d normal(xx, xy, x, xy, yy, y, x, y, n);
    const cv::Vec3d plane = normal.solve(cv::Vec3d(xd, yd, d), cv::DECOMP_CHOLESKY);
    return {plane[0], plane[1], plane[2]};
}

}  // namespace

Answer plane_ransac_pose(const Input& input, const Samples& samples, const PlaneRansacOptions& options) {
    const std::vector<Point> points = points_of(input, samples, options.sparse);
    if (points.size() < 100) return no_road();
    std::optional<DisparityPlane> plane = ransac(points, options.band_px, input.rig());
    for (int round = 0; plane && round < 3; ++round) plane = least_squares(points, *plane, options.band_px);
    return plane ? answer_of(*plane, input.rig()) : no_road();
}

}  // namespace evaluation
