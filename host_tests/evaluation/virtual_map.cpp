#include "virtual_map.hpp"

#include <opencv2/imgproc.hpp>

#include "line_fit.hpp"
#include "slope_of_levels.hpp"

namespace evaluation {
namespace {

constexpr double degree = 3.14159265358979323846 / 180;
constexpr double negligible_roll = 0.005 * degree;
constexpr int rounds_max = 20;
constexpr double obstacle_m = 0.4, tallest_m = 4.0, tilt = 1.15;

cv::Mat1w u_disparity(const cv::Mat1f& disparity) {
    cv::Mat1w histogram(disparity.cols, levels, std::uint16_t{0});
    for (int v = 0; v < disparity.rows; ++v)
        for (int u = 0; u < disparity.cols; ++u)
            if (disparity(v, u) > 0 && disparity(v, u) < levels) ++histogram(u, static_cast<int>(disparity(v, u)));
    return histogram;
}

bool is_obstacle(const cv::Mat1w& u_histogram, int u, int level, const recording_rig_t& rig) {
    const int before = level > 0 ? u_histogram(u, level - 1) : 0;
    const int after = level + 1 < levels ? u_histogram(u, level + 1) : 0;
    const double road = 1 + 2 * tilt * tallest_m / rig.baseline_m;
    return u_histogram(u, level) + std::max(before, after) > road + obstacle_m * level / rig.baseline_m;
}

// Turns until no roll is left; *map becomes what the virtual camera sees. False where no slope was found.
bool turn_level(const cv::Mat1f& seen, const recording_rig_t& rig, cv::Mat1f& map, double& roll) {
    roll = 0;
    map = seen;
    for (int round = 0; round < rounds_max; ++round) {
        const std::optional<double> slope = slope_of_levels(map);
        if (!slope) return false;
        const double left = std::atan(-*slope);
        roll += left;
        map = turned_back(seen, rig, roll);
        if (std::abs(left) < negligible_roll) break;
    }
    return true;
}

}  // namespace

cv::Mat1f turned_back(const cv::Mat1f& disparity, const recording_rig_t& rig, double roll_rad) {
    const double c = std::cos(roll_rad), s = std::sin(roll_rad);
    const cv::Matx23d turn(c, -s, rig.cu_px - c * rig.cu_px + s * rig.cv_px, s, c, rig.cv_px - s * rig.cu_px - c * rig.cv_px);
    cv::Mat1f map;
    cv::warpAffine(disparity, map, turn, disparity.size(), cv::INTER_NEAREST, cv::BORDER_CONSTANT, 0);
    return map;
}

cv::Mat1f free_pixels(const cv::Mat1f& disparity, const recording_rig_t& rig) {
    const cv::Mat1w histogram = u_disparity(disparity);
    cv::Mat1f free = disparity.clone();
    for (int v = 0; v < free.rows; ++v)
        for (int u = 0; u < free.cols; ++u)
            if (free(v, u) > 0 && (free(v, u) >= levels || is_obstacle(histogram, u, static_cast<int>(free(v, u)), rig)))
                free(v, u) = 0;
    return free;
}

Answer virtual_map_pose(const Input& input, MapPixels pixels) {
    const recording_rig_t& rig = input.rig();
    const cv::Mat1f seen = pixels == MapPixels::free ? free_pixels(input.disparity, rig) : input.disparity;
    cv::Mat1f map;
    double roll;
    if (!turn_level(seen, rig, map, roll)) return no_road();
    const cv::Mat1w histogram = v_disparity(map);
    const std::optional<Line> line = ransac_line(histogram, rig);
    if (!line) return no_road();
    const Profile profile = profile_of(least_squares_line(histogram, *line, 1.5, rig), rig);
    const Pose pose{profile.pitch_deg, roll / degree, profile.height_m};
    return is_within_limits(pose) ? Answer{"ok", true, pose} : no_road();
}

}  // namespace evaluation
