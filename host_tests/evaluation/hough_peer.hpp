// What a project with OpenCV would do first: v-disparity of the whole map, threshold, the strongest Hough line that can
// be a road.
#pragma once
#include "candidates.hpp"
#include "samples.hpp"

namespace evaluation {

struct HoughOptions {
    double rho_px, theta_deg;   // resolution
    bool least_squares;         // of the histogram within 1.5 levels of the line, after it
};

Answer hough_pose(const Input& input, const Samples& samples, const HoughOptions& options);

// The pass that it begins with: for each kept pixel of each row one count at its whole disparity.
cv::Mat1w v_disparity_of(const Input& input, const Samples& samples);

}  // namespace evaluation
