// A pose as lines in the image: the horizon, and what lies on the road at a place ahead and aside.
#pragma once
#include <opencv2/core.hpp>

#include <optional>

#include "roadpose/roadpose.h"

namespace evaluation {

class RoadView {
public:
    RoadView(const roadpose_rig_t& rig, const roadpose_pose_t& pose);

    // Pixel of the road point this far ahead and to the right of the camera, metres along the road; empty behind it.
    std::optional<cv::Point2d> at(double ahead_m, double right_m) const;
    double disparity(double u, double v) const;
    double horizon_row(double u) const;
    double row_of(double u, double disparity_px) const;

private:
    double focal_, cu_, cv_, height_;
    cv::Vec3d normal_, plane_;
};

}  // namespace evaluation
