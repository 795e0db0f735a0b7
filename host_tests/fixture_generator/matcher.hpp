// Disparity maps from OpenCV's own matchers, in the sample format of a recording.
#pragma once
#include <opencv2/core.hpp>

#include "renderer.hpp"
#include "rig.hpp"

namespace fixtures {

constexpr int disparity_scale = 256;  // sample = disparity in pixels × 256; 0 = no match

enum class Matcher { semi_global, block };

const char* matcher_name(Matcher matcher);

// CV_16U, height × width of the rig.
cv::Mat match(const StereoPair& pair, const Rig& rig, Matcher matcher);

}  // namespace fixtures
