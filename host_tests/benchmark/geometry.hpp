// The road plane in double precision: in camera axes, in disparity space, as ISO 8855 angles.
#pragma once
#include "recording_file.h"

namespace benchmark {

struct Pose {
    double pitch_deg;
    double roll_deg;
    double height_m;
};

// d(u, v) = a (u - cu) + b (v - cv) + c, pixels.
struct DisparityPlane {
    double a, b, c;
    double at(double x, double y) const { return a * x + b * y + c; }
};

Pose pose_of(const DisparityPlane& plane, const recording_rig_t& rig);
DisparityPlane plane_of(const Pose& pose, const recording_rig_t& rig);

}  // namespace benchmark
