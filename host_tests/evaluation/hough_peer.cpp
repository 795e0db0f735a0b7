#include "hough_peer.hpp"

#include <opencv2/imgproc.hpp>

#include "corridor.hpp"
#include "line_fit.hpp"

namespace evaluation {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr int searched_levels = 128;      // as far as the matcher searched: no work on empty cells
constexpr double filled_share = 0.02;     // a cell counts as filled above this share of the image's width

cv::Mat1w histogram_of(const Input& input, bool cropped) {
    if (!cropped) return v_disparity(input.disparity);
    const recording_rig_t& rig = input.rig();
    cv::Mat1w histogram(input.disparity.rows, levels, std::uint16_t{0});
    for (int v = 0; v < input.disparity.rows; ++v)
        for (int u = 0; u < input.disparity.cols; ++u) {
            const float disparity = input.disparity(v, u);
            if (disparity > 0 && disparity < levels && is_in_crop(rig, u - rig.cu_px, disparity))
                ++histogram(v, static_cast<int>(disparity));
        }
    return histogram;
}

// Image of the histogram: column = level, row = v; the line is x cos(theta) + y sin(theta) = rho.
Line line_of(const cv::Vec2f& hough, const recording_rig_t& rig) {
    const double c = std::cos(hough[1]), s = std::sin(hough[1]);
    const double slope = -s / c, at_row_zero = hough[0] / c + 0.5;
    return {slope, at_row_zero + slope * rig.cv_px};
}

std::optional<Line> strongest_road(const cv::Mat1w& histogram, const HoughOptions& options, const recording_rig_t& rig) {
    const cv::Mat filled = histogram.colRange(0, searched_levels) > filled_share * rig.width;
    std::vector<cv::Vec2f> found;  // strongest first
    cv::HoughLines(filled, found, options.rho_px, options.theta_deg * pi / 180, 40, 0, 0, pi / 2, pi);
    for (const cv::Vec2f& hough : found) {
        if (std::abs(std::cos(hough[1])) < 1e-3) continue;
        const Line line = line_of(hough, rig);
        if (is_possible(line, rig)) return line;
    }
    return std::nullopt;
}

}  // namespace

Answer hough_pose(const Input& input, const HoughOptions& options) {
    const recording_rig_t& rig = input.rig();
    const cv::Mat1w histogram = histogram_of(input, options.cropped);
    std::optional<Line> line = strongest_road(histogram, options, rig);
    if (!line) return no_road();
    if (options.least_squares) line = least_squares_line(histogram, *line, 1.5, rig);
    const Profile profile = profile_of(*line, rig);
    return {"ok", false, {profile.pitch_deg, 0, profile.height_m}};
}

}  // namespace evaluation
