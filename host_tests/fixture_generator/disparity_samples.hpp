// The sample format of a recording's disparity maps.
#pragma once

namespace fixtures {

constexpr int disparity_scale = 256;  // 16-bit sample = disparity in pixels × 256; 0 = no match

}  // namespace fixtures
