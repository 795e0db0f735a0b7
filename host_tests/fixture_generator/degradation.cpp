#include "degradation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "disparity_samples.hpp"

namespace fixtures {
namespace {

std::uint16_t sample_of(double disparity_px) {
    return static_cast<std::uint16_t>(std::clamp(std::floor(disparity_px * disparity_scale + 0.5), 1.0, 65535.0));
}

template <typename Change>
void for_each_sample(cv::Mat& disparity, Change change) {
    for (int row = 0; row < disparity.rows; ++row)
        for (int column = 0; column < disparity.cols; ++column) change(disparity.at<std::uint16_t>(row, column));
}

void add_blob(cv::Mat& disparity, double largest_px, Lcg& random) {
    const double level = random.uniform(0.1, 1.0) * largest_px, spread = random.uniform(0.2, 2.0);
    const int radius = random.integer(4, 22);
    const int u = random.integer(0, disparity.cols - 1), v = random.integer(0, disparity.rows - 1);
    for (int row = std::max(v - radius, 0); row < std::min(v + radius, disparity.rows); ++row)
        for (int column = std::max(u - radius, 0); column < std::min(u + radius, disparity.cols); ++column) {
            const int du = column - u, dv = row - v;
            if (du * du + dv * dv < radius * radius && random.chance(0.6))
                disparity.at<std::uint16_t>(row, column) = sample_of(std::max(level + spread * random.normal(), 0.1));
        }
}

}  // namespace

void lose_everything(cv::Mat& disparity) { disparity.setTo(0); }

void lose_row_bands(cv::Mat& disparity, int bands, int tallest, Lcg& random) {
    for (int i = 0; i < bands; ++i) {
        const int first = random.integer(disparity.rows / 3, disparity.rows - 1);
        const int last = std::min(first + random.integer(2, tallest), disparity.rows);
        disparity.rowRange(first, last).setTo(0);
    }
}

void lose_regions(cv::Mat& disparity, int regions, Lcg& random) {
    for (int i = 0; i < regions; ++i) {
        const int width = random.integer(disparity.cols / 16, disparity.cols / 4);
        const int height = random.integer(disparity.rows / 16, disparity.rows / 4);
        const int left = random.integer(0, disparity.cols - width), top = random.integer(0, disparity.rows - height);
        disparity(cv::Rect(left, top, width, height)).setTo(0);
    }
}

void lose_at_random(cv::Mat& disparity, double share, Lcg& random) {
    for_each_sample(disparity, [&](std::uint16_t& sample) { if (random.chance(share)) sample = 0; });
}

void add_salt(cv::Mat& disparity, double share, double largest_px, Lcg& random) {
    for_each_sample(disparity, [&](std::uint16_t& sample) {
        if (random.chance(share)) sample = sample_of(random.uniform(0.1, largest_px));
    });
}

void replace_by_noise(cv::Mat& disparity, double largest_px, Lcg& random) {
    for_each_sample(disparity, [&](std::uint16_t& sample) { sample = sample_of(random.uniform(0.1, largest_px)); });
}

void replace_by_fog(cv::Mat& disparity, double largest_px, Lcg& random) {
    lose_everything(disparity);
    for (int i = random.integer(3, 12); i > 0; --i) add_blob(disparity, largest_px, random);
    add_salt(disparity, random.uniform(0.002, 0.02), largest_px, random);
}

}  // namespace fixtures
