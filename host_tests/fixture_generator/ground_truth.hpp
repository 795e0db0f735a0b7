// The true road plane of a frame, and double-precision least squares to check it and to measure a matcher against it.
#pragma once
#include <opencv2/core.hpp>

#include <string>

#include "renderer.hpp"
#include "rig.hpp"
#include "scene.hpp"

namespace fixtures {

// Flat road (bump excluded): the plane z = 0. Crowned road: least-squares plane of the exact surface over a uniform
// 0.1 m grid of ±2 m sideways and 3–25 m ahead of the camera.
RoadPlane true_road_plane(const RoadSurface& road, const Pose& pose);

struct PoseError {
    double pitch_deg = 0.0;
    double roll_deg = 0.0;
    double height_mm = 0.0;
};

struct FrameCheck {
    int road_pixels = 0;
    double valid_share = 0.0;   // of the road pixels
    double bias_px = 0.0;       // median of matched − exact on road pixels
    double noise_px = 0.0;      // 1.4826 × median absolute deviation of the same
    double outlier_share = 0.0; // of the valid road pixels: more than 1 px from exact
    PoseError exact_fit;        // least squares of the exact disparities on road pixels
    PoseError matched_fit;      // least squares of the matched disparities, band 1.5 → 0.6 → 0.35 px around the plane
};

// disparity: CV_16U samples. On a crowned road only the pixels of the corridor count.
FrameCheck check_frame(const StereoPair& pair, const cv::Mat& disparity, const Rig& rig, const RoadPlane& truth,
                       bool corridor_only);

std::string header_of_check();
std::string to_text(const FrameCheck& check);

}  // namespace fixtures
