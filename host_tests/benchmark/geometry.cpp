#include "geometry.hpp"

#include <cmath>

namespace benchmark {
namespace {
const double degree = std::acos(-1.0) / 180;
}

Pose pose_of(const DisparityPlane& plane, const recording_rig_t& rig) {
    const double forward = plane.c / rig.focal_px;
    const double length = std::hypot(plane.a, plane.b, forward);
    return {std::asin(forward / length) / degree, std::atan2(plane.a, plane.b) / degree, rig.baseline_m / length};
}

DisparityPlane plane_of(const Pose& pose, const recording_rig_t& rig) {
    const double pitch = pose.pitch_deg * degree, roll = pose.roll_deg * degree;
    const double scale = rig.baseline_m / pose.height_m;
    return {scale * std::cos(pitch) * std::sin(roll), scale * std::cos(pitch) * std::cos(roll),
            scale * rig.focal_px * std::sin(pitch)};
}

}  // namespace benchmark
