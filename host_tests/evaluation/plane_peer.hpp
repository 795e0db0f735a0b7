// The plain way in disparity space: RANSAC of a plane through three points, then least squares, in double precision.
#pragma once
#include "candidates.hpp"
#include "samples.hpp"

namespace evaluation {

struct PlaneRansacOptions {
    bool sparse;      // one pixel in 2 x 4, as the library samples
    double band_px;   // inliers
};

Answer plane_ransac_pose(const Input& input, const Samples& samples, const PlaneRansacOptions& options);

}  // namespace evaluation
