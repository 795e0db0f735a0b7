// The plain way in disparity space: RANSAC of a plane through three points, then least squares, in double precision.
#pragma once
#include "candidates.hpp"

namespace evaluation {

struct PlaneRansacOptions {
    bool cropped;     // only what lies within 3 m sideways and 25 m ahead
    bool sparse;      // one pixel in 2 x 4, as the library samples
    double band_px;   // inliers
};

Answer plane_ransac_pose(const Input& input, const PlaneRansacOptions& options);

}  // namespace evaluation
