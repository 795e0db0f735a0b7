// What a project with OpenCV would do first: v-disparity of the whole map, threshold, the strongest Hough line that can
// be a road.
#pragma once
#include "candidates.hpp"

namespace evaluation {

struct HoughOptions {
    double rho_px, theta_deg;   // resolution
    bool least_squares;         // of the histogram within 1.5 levels of the line, after it
    bool cropped;               // only what lies within 3 m sideways and 25 m ahead
};

Answer hough_pose(const Input& input, const HoughOptions& options);

}  // namespace evaluation
