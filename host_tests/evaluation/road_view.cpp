#include "road_view.hpp"

namespace evaluation {

RoadView::RoadView(const roadpose_rig_t& rig, const roadpose_pose_t& pose)
    : focal_(rig.focal_millipx / 1e3), cu_(rig.cu_millipx / 1e3), cv_(rig.cv_millipx / 1e3), height_(pose.height_um / 1e6),
      normal_(cv::Vec3d(pose.normal_q30[0], pose.normal_q30[1], pose.normal_q30[2]) / double(1 << 30)),
      plane_(pose.plane_u_q24 / double(1 << 24), pose.plane_v_q24 / double(1 << 24), pose.plane_0_q16 / double(1 << 16)) {}

std::optional<cv::Point2d> RoadView::at(double ahead_m, double right_m) const {
    const cv::Vec3d axis(0, 0, 1);
    const cv::Vec3d forward = cv::normalize(axis - axis.dot(normal_) * normal_), right = normal_.cross(forward);
    const cv::Vec3d point = height_ * normal_ + ahead_m * forward + right_m * right;
    if (point[2] < 0.1) return std::nullopt;
    return cv::Point2d(cu_ + focal_ * point[0] / point[2], cv_ + focal_ * point[1] / point[2]);
}

double RoadView::disparity(double u, double v) const { return plane_.dot({u - cu_, v - cv_, 1}); }
double RoadView::row_of(double u, double disparity_px) const {
    return cv_ + (disparity_px - plane_[2] - plane_[0] * (u - cu_)) / plane_[1];
}
double RoadView::horizon_row(double u) const { return row_of(u, 0); }

}  // namespace evaluation
