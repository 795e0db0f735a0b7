// The slope of the image lines of constant disparity, dv/du, by RANSAC over pairs of pixels of one level.
#pragma once
#include <opencv2/core.hpp>

#include <optional>

namespace evaluation {

std::optional<double> slope_of_levels(const cv::Mat1f& disparity);

}  // namespace evaluation
