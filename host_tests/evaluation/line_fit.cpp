#include "line_fit.hpp"

#include <cmath>
#include <vector>

#include "random_numbers.hpp"

namespace evaluation {
namespace {

struct Cell {
    double y, disparity, count;  // the middle of a level
};

std::vector<Cell> filled_cells(const cv::Mat1w& histogram, const recording_rig_t& rig) {
    std::vector<Cell> cells;
    for (int v = 0; v < histogram.rows; ++v)
        for (int level = 0; level < histogram.cols; ++level)
            if (histogram(v, level)) cells.push_back({v - rig.cv_px, level + 0.5, double(histogram(v, level))});
    return cells;
}

std::vector<double> running_sum(const std::vector<Cell>& cells) {
    std::vector<double> sums;
    for (const Cell& cell : cells) sums.push_back((sums.empty() ? 0 : sums.back()) + cell.count);
    return sums;
}

// Drawn with the probability of its count.
const Cell& draw(const std::vector<Cell>& cells, const std::vector<double>& sums, Random& random) {
    const auto place = std::upper_bound(sums.begin(), sums.end(), random.unit() * sums.back());
    return cells[std::min<std::size_t>(place - sums.begin(), cells.size() - 1)];
}

double support(const std::vector<Cell>& cells, const Line& line) {
    double sum = 0;
    for (const Cell& cell : cells)
        if (std::abs(cell.disparity - line.at(cell.y)) <= 1.0) sum += cell.count;
    return sum;
}

}  // namespace

cv::Mat1w v_disparity(const cv::Mat1f& disparity) {
    cv::Mat1w histogram(disparity.rows, levels, std::uint16_t{0});
    for (int v = 0; v < disparity.rows; ++v)
        for (int u = 0; u < disparity.cols; ++u)
            if (disparity(v, u) > 0 && disparity(v, u) < levels) ++histogram(v, static_cast<int>(disparity(v, u)));
    return histogram;
}

Profile profile_of(const Line& line, const recording_rig_t& rig) {
    const double pitch = std::atan2(line.intercept, rig.focal_px * line.slope);
    return {pitch * 180 / std::acos(-1.0), rig.baseline_m * std::cos(pitch) / line.slope};
}

bool is_possible(const Line& line, const recording_rig_t& rig) {
    if (line.slope <= 0) return false;
    const Profile profile = profile_of(line, rig);
    return profile.pitch_deg >= -10 && profile.pitch_deg <= 15 && profile.height_m >= 0.3 && profile.height_m <= 4;
}

std::optional<Line> ransac_line(const cv::Mat1w& histogram, const recording_rig_t& rig) {
    const std::vector<Cell> cells = filled_cells(histogram, rig);
    if (cells.size() < 2) return std::nullopt;
    const std::vector<double> sums = running_sum(cells);
    Random random(1);
    std::optional<Line> best;
    double best_support = 0;
    for (int hypothesis = 0; hypothesis < 256; ++hypothesis) {
        const Cell &one = draw(cells, sums, random), &other = draw(cells, sums, random);
        if (one.y == other.y) continue;
        const double slope = (one.disparity - other.disparity) / (one.y - other.y);
        const Line line{slope, one.disparity - slope * one.y};
        if (!is_possible(line, rig)) continue;
        const double line_support = support(cells, line);
        if (line_support > best_support) best = line, best_support = line_support;
    }
    return best;
}

Line least_squares_line(const cv::Mat1w& histogram, const Line& start, double band_px, const recording_rig_t& rig) {
    double n = 0, y = 0, d = 0, yy = 0, yd = 0;
    for (int v = 0; v < histogram.rows; ++v) {
        const double row = v - rig.cv_px, middle = start.at(row);
        const int first = std::max(0, static_cast<int>(std::ceil(middle - band_px - 0.5)));
        const int last = std::min(histogram.cols - 1, static_cast<int>(std::floor(middle + band_px - 0.5)));
        for (int level = first; level <= last; ++level) {
            const double count = histogram(v, level), disparity = level + 0.5;
            n += count, y += count * row, d += count * disparity, yy += count * row * row, yd += count * row * disparity;
        }
    }
    const double determinant = n * yy - y * y;
    if (n < 2 || determinant <= 0) return start;
    const double slope = (n * yd - y * d) / determinant;
    return {slope, (d - slope * y) / n};
}

}  // namespace evaluation
