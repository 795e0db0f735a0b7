#include "slope_of_levels.hpp"

#include <cmath>
#include <vector>

#include "random_numbers.hpp"

namespace evaluation {
namespace {

constexpr int buckets_per_px = 4, bucket_count = 256 * buckets_per_px, pair_count = 4096, hypotheses = 256;
constexpr double steepest = 0.7;  // 35 degrees

struct Pair {
    double du, dv;
};

std::vector<std::vector<cv::Point>> sort_by_level(const cv::Mat1f& disparity) {
    std::vector<std::vector<cv::Point>> buckets(bucket_count);
    for (int v = 0; v < disparity.rows; ++v)
        for (int u = 0; u < disparity.cols; ++u) {
            const int bucket = static_cast<int>(disparity(v, u) * buckets_per_px);
            if (bucket > 0 && bucket < bucket_count) buckets[bucket].emplace_back(u, v);
        }
    return buckets;
}

// Every level counts the same, so that the few metres before the car do not decide alone.
std::vector<Pair> draw_pairs(const std::vector<std::vector<cv::Point>>& buckets) {
    Random random(1);
    std::vector<Pair> pairs;
    for (int attempt = 0; attempt < 16 * pair_count && pairs.size() < pair_count; ++attempt) {
        const std::vector<cv::Point>& level = buckets[random.below(bucket_count)];
        if (level.size() < 2) continue;
        const cv::Point apart = level[random.below(level.size())] - level[random.below(level.size())];
        if (std::abs(apart.x) >= 32) pairs.push_back({double(apart.x), double(apart.y)});
    }
    return pairs;
}

bool agrees(const Pair& pair, double slope) { return std::abs(pair.dv - slope * pair.du) <= 2.0; }

double least_squares(const std::vector<Pair>& pairs, double slope) {
    double uu = 0, uv = 0;
    for (const Pair& pair : pairs)
        if (agrees(pair, slope)) uu += pair.du * pair.du, uv += pair.du * pair.dv;
    return uu > 0 ? uv / uu : slope;
}

}  // namespace

std::optional<double> slope_of_levels(const cv::Mat1f& disparity) {
    const std::vector<Pair> pairs = draw_pairs(sort_by_level(disparity));
    if (pairs.size() < 64) return std::nullopt;
    double best = 0;
    std::size_t best_support = 0;
    for (std::size_t i = 0; i < hypotheses; ++i) {
        const Pair& pair = pairs[i * pairs.size() / hypotheses];
        const double slope = pair.dv / pair.du;
        if (std::abs(slope) > steepest) continue;
        const auto support = static_cast<std::size_t>(
            std::count_if(pairs.begin(), pairs.end(), [slope](const Pair& other) { return agrees(other, slope); }));
        if (support > best_support) best = slope, best_support = support;
    }
    if (best_support < 32) return std::nullopt;
    return least_squares(pairs, least_squares(pairs, best));
}

}  // namespace evaluation
