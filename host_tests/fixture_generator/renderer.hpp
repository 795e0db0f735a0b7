// Both 8-bit images of a stereo pair, and what is exactly true at every pixel centre of the left one.
#pragma once
#include <opencv2/core.hpp>

#include <cstdint>

#include "rig.hpp"
#include "scene.hpp"

namespace fixtures {

struct StereoPair {
    int padding = 0;          // extra columns to the left of column 0, so that the matcher covers the whole left image
    cv::Mat left;             // CV_8U, height × (padding + width)
    cv::Mat right;            // CV_8U, the same
    cv::Mat exact_disparity;  // CV_64F, height × width; 0 = sky
    cv::Mat road;             // CV_8U, 1 = the ray through the pixel centre hits the road (bump and pavement excluded)
};

struct SensorNoise {
    double standard_deviation = 1.2;  // grey levels
    double right_gain = 1.01;
    std::uint64_t seed = 1;
};

StereoPair render(const Scene& scene, const Rig& rig, const Pose& pose, const SensorNoise& noise);

}  // namespace fixtures
