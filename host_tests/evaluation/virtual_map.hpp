// The paper's two other methods, as we read them. The roll is taken from the slope of the lines of constant disparity;
// the map is re-seen by a virtual camera that is turned back by it; this is repeated until the roll that is left is
// negligible; then Method 1 finds pitch and height in the virtual map. The *virtual disparity map* re-sees all pixels,
// the *virtual free map* those of the free map. Comparators only: the library does not need them.
#pragma once
#include "candidates.hpp"

namespace evaluation {

enum class MapPixels { all, free };

// The map as a camera turned about the optical axis by roll_rad sees it; nearest neighbour, 0 = nothing.
cv::Mat1f turned_back(const cv::Mat1f& disparity, const recording_rig_t& rig, double roll_rad);

// Full resolution, whole image; the same rule as the library's free map with its default of 0.4 m.
cv::Mat1f free_pixels(const cv::Mat1f& disparity, const recording_rig_t& rig);

Answer virtual_map_pose(const Input& input, MapPixels pixels);

}  // namespace evaluation
