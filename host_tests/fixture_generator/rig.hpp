// The stereo rig, its pose in the world, and the road plane in camera axes.
// World and vehicle axes: X forward, Y left, Z up. Camera axes: x right, y down, z forward. Angles in radians.
#pragma once
#include <opencv2/core.hpp>

#include <cmath>

namespace fixtures {

constexpr double pi = 3.14159265358979323846;
inline double radians(double degrees) { return degrees * pi / 180.0; }
inline double degrees(double radians_) { return radians_ * 180.0 / pi; }

struct Rig {
    int width = 640;
    int height = 480;
    double focal_px = 500.0;
    double cu_px = 319.5;
    double cv_px = 239.5;
    double baseline_m = 0.30;
    int disparity_range = 128;
};

struct Pose {
    double pitch = 0.0;  // + = nose down
    double roll = 0.0;   // + = right side down
    double yaw = 0.0;    // + = looks to the left
    cv::Vec3d position{0.0, 0.0, 1.5};
};

// Every road point P in camera axes satisfies normal · P = height.
struct RoadPlane {
    cv::Vec3d normal{0.0, 1.0, 0.0};
    double height = 1.5;

    double pitch() const { return std::asin(normal[2]); }
    double roll() const { return std::atan2(normal[0], normal[1]); }
};

// Columns are the camera's axes in world coordinates: yaw, then pitch, then roll, each about the axis already turned.
inline cv::Matx33d camera_to_world(const Pose& pose) {
    const double cy = std::cos(pose.yaw), sy = std::sin(pose.yaw);
    const double cp = std::cos(pose.pitch), sp = std::sin(pose.pitch);
    const double cr = std::cos(pose.roll), sr = std::sin(pose.roll);
    const cv::Matx33d yaw(cy, -sy, 0, sy, cy, 0, 0, 0, 1);
    const cv::Matx33d pitch(cp, 0, sp, 0, 1, 0, -sp, 0, cp);
    const cv::Matx33d roll(1, 0, 0, 0, cr, -sr, 0, sr, cr);
    const cv::Matx33d camera_in_vehicle(0, 0, 1, -1, 0, 0, 0, -1, 0);
    return yaw * pitch * roll * camera_in_vehicle;
}

}  // namespace fixtures
