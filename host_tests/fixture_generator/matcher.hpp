// Disparity maps from OpenCV's own matchers, as the 16-bit samples of a recording.
#pragma once
#include <opencv2/core.hpp>

#include "renderer.hpp"
#include "rig.hpp"

namespace fixtures {

enum class Matcher { semi_global, block };

const char* matcher_name(Matcher matcher);

// CV_16U, height × width of the rig.
cv::Mat match(const StereoPair& pair, const Rig& rig, Matcher matcher);

}  // namespace fixtures
