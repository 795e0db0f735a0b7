// A street as geometry: a road surface, solids that stand on it, a bonnet fixed to the camera; and the first thing a
// ray hits.
#pragma once
#include <opencv2/core.hpp>

#include <cmath>
#include <optional>
#include <vector>

#include "rig.hpp"
#include "texture.hpp"

namespace fixtures {

struct RoadSurface {
    Texture texture;
    bool present = true;
    double crown = 0.0;         // z = −crown·y², 1/m; the crown line is y = 0
    double bump_start = 0.0;    // x of the bump's near foot, metres
    double bump_length = 0.0;   // 0 = no bump
    double bump_height = 0.0;
    double elevation(double x, double y) const;
};

enum class Shape { box, cylinder, sphere };

struct Solid {
    Shape shape = Shape::box;
    cv::Vec3d centre;
    cv::Vec3d half_size;        // box: along its own axes; cylinder: radius, 0, half height; sphere: radius, 0, 0
    cv::Vec2d heading{1.0, 0.0};  // box: cosine and sine of its yaw
    Texture texture;
};

inline cv::Vec2d heading_of(double yaw) { return {std::cos(yaw), std::sin(yaw)}; }

// A bonnet in camera axes: y = drop + tilt·z + curvature·x², up to z = length. Moves with the camera.
struct Bonnet {
    double drop = 0.5;
    double tilt = 0.0;
    double curvature = 0.05;
    double length = 1.6;
    double half_width = 0.9;
    Texture texture;
};

struct Scene {
    RoadSurface road;
    std::vector<Solid> solids;
    std::optional<Bonnet> bonnet;
    double sky_grey = 205.0;
};

// World ray; the parameter is the depth along the optical axis because the direction has z = 1 in camera axes.
struct Ray {
    cv::Vec3d origin;
    cv::Vec3d direction;
    cv::Vec3d camera_origin;     // the same ray in left-camera axes, for the bonnet
    cv::Vec3d camera_direction;
};

enum class Surface { sky, road, bump, obstacle, bonnet };

struct Hit {
    Surface surface = Surface::sky;
    double depth = 1e9;
    const Texture* texture = nullptr;
    cv::Vec3d normal;          // in the axes of texture_axis_*: world, or camera for the bonnet
    cv::Vec3d texture_axis_s;
    cv::Vec3d texture_axis_t;
    cv::Vec2d texture_point;
};

Hit first_hit(const Scene& scene, const Ray& ray);

}  // namespace fixtures
