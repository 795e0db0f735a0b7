#include "hough_peer.hpp"

#include <opencv2/imgproc.hpp>

#include "line_fit.hpp"

namespace evaluation {
namespace {

constexpr double degree = 3.14159265358979323846 / 180;
constexpr unsigned searched_levels = 128;      // as far as the matcher searched: no work on empty cells
constexpr double filled_share = 0.02;     // a cell counts as filled above this share of the image's width
constexpr int votes_min = 40;

// Image of the histogram: column = level, row = v; the line is x cos(theta) + y sin(theta) = rho.
Line line_of(const cv::Vec2f& hough, const recording_rig_t& rig) {
    const double c = std::cos(hough[1]), s = std::sin(hough[1]);
    const double slope = -s / c, at_row_zero = hough[0] / c + 0.5;
    return {slope, at_row_zero + slope * rig.cv_px};
}

// Only lines of a slope that the mounting limits allow are searched: heights of 0.3...4 m, pitch up to 15 degrees.
std::optional<Line> strongest_road(const cv::Mat1w& histogram, const HoughOptions& options, const recording_rig_t& rig) {
    const cv::Mat filled = histogram > filled_share * rig.width;
    const double first = 180 * degree - std::atan(rig.baseline_m / 0.3);
    const double last = 180 * degree - std::atan(rig.baseline_m * std::cos(15 * degree) / 4);
    std::vector<cv::Vec2f> found;  // strongest first
    cv::HoughLines(filled, found, options.rho_px, options.theta_deg * degree, votes_min, 0, 0, first, last);
    for (const cv::Vec2f& hough : found) {
        const Line line = line_of(hough, rig);
        if (is_possible(line, rig)) return line;
    }
    return std::nullopt;
}

}  // namespace

cv::Mat1w v_disparity_of(const Input& input, const Samples& samples) {
    const recording_rig_t& rig = input.rig();
    const SampleReader read = samples.reader();  // a local: nothing in it is fetched again for each pixel
    cv::Mat1w histogram(rig.height, static_cast<int>(searched_levels), std::uint16_t{0});
    for (int v = 0; v < rig.height; ++v) {
        const std::uint16_t* const sample = &input.native[static_cast<std::size_t>(v) * rig.width];
        std::uint16_t* const row = histogram[v];
        for (int u = 0; u < rig.width; ++u)
            if (read.keeps(u, sample[u]) && read.level(sample[u]) < searched_levels) ++row[read.level(sample[u])];
    }
    return histogram;
}

Answer hough_pose(const Input& input, const Samples& samples, const HoughOptions& options) {
    const recording_rig_t& rig = input.rig();
    const cv::Mat1w histogram = v_disparity_of(input, samples);
    std::optional<Line> line = strongest_road(histogram, options, rig);
    if (!line) return no_road();
    if (options.least_squares) line = least_squares_line(histogram, *line, 1.5, rig);
    const Profile profile = profile_of(*line, rig);
    return {"ok", false, {profile.pitch_deg, 0, profile.height_m}};
}

}  // namespace evaluation
