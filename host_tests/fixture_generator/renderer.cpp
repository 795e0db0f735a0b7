#include "renderer.hpp"

#include <algorithm>
#include <cmath>

#include "hashing.hpp"

namespace fixtures {
namespace {

// Rays a pixel, in each direction: softens the outlines; textures are filtered on their own.
constexpr int supersampling = 2;

struct Camera {
    Rig rig;
    cv::Matx33d to_world;
    cv::Vec3d left_centre;
    double baseline_shift;  // metres to the right of the left camera

    Ray ray(double u, double v) const {
        const cv::Vec3d direction((u - rig.cu_px) / rig.focal_px, (v - rig.cv_px) / rig.focal_px, 1.0);
        const cv::Vec3d origin(baseline_shift, 0.0, 0.0);
        return {left_centre + to_world * origin, to_world * direction, origin, direction};
    }
};

// How far the hit point slides over the surface when the ray moves by this camera axis, per subpixel.
cv::Vec2d footprint_edge(const Hit& hit, const cv::Vec3d& axis, const cv::Vec3d& direction, double subpixel) {
    double facing = hit.normal.dot(direction);
    if (std::abs(facing) < 1e-4) facing = facing < 0 ? -1e-4 : 1e-4;
    const cv::Vec3d slide = (axis - direction * (hit.normal.dot(axis) / facing)) * (hit.depth * subpixel);
    return {slide.dot(hit.texture_axis_s), slide.dot(hit.texture_axis_t)};
}

double shading(const Hit& hit) {
    if (hit.surface == Surface::bonnet) return 1.0;
    const cv::Vec3d& n = hit.normal;
    return 0.75 + 0.25 * std::abs(n[2]) + 0.1 * n[0] * n[0];
}

double grey_along(const Scene& scene, const Camera& camera, double u, double v) {
    const Ray ray = camera.ray(u, v);
    const Hit hit = first_hit(scene, ray);
    if (hit.surface == Surface::sky) return scene.sky_grey;
    const double subpixel = 1.0 / (camera.rig.focal_px * supersampling);
    const bool on_bonnet = hit.surface == Surface::bonnet;
    const cv::Vec3d x_axis = on_bonnet ? cv::Vec3d(1, 0, 0) : camera.to_world * cv::Vec3d(1, 0, 0);
    const cv::Vec3d y_axis = on_bonnet ? cv::Vec3d(0, 1, 0) : camera.to_world * cv::Vec3d(0, 1, 0);
    const cv::Vec3d& direction = on_bonnet ? ray.camera_direction : ray.direction;
    const Footprint footprint{footprint_edge(hit, x_axis, direction, subpixel),
                              footprint_edge(hit, y_axis, direction, subpixel)};
    return grey_value(*hit.texture, hit.texture_point, footprint) * shading(hit);
}

double pixel_grey(const Scene& scene, const Camera& camera, int column, int row) {
    double sum = 0.0;
    for (int j = 0; j < supersampling; ++j)
        for (int i = 0; i < supersampling; ++i)
            sum += grey_along(scene, camera, column + (i + 0.5) / supersampling - 0.5,
                              row + (j + 0.5) / supersampling - 0.5);
    return sum / (supersampling * supersampling);
}

cv::Mat render_image(const Scene& scene, const Camera& camera, int padding, double gain, double noise, Lcg random) {
    cv::Mat image(camera.rig.height, camera.rig.width + padding, CV_8U);
    for (int row = 0; row < image.rows; ++row) {
        std::uint8_t* pixels = image.ptr<std::uint8_t>(row);
        for (int column = 0; column < image.cols; ++column) {
            const double grey = gain * pixel_grey(scene, camera, column - padding, row) + noise * random.normal();
            pixels[column] = static_cast<std::uint8_t>(std::clamp(std::floor(grey + 0.5), 0.0, 255.0));
        }
    }
    return image;
}

void render_truth(const Scene& scene, const Camera& left, StereoPair& pair) {
    const Rig& rig = left.rig;
    pair.exact_disparity = cv::Mat::zeros(rig.height, rig.width, CV_64F);
    pair.road = cv::Mat::zeros(rig.height, rig.width, CV_8U);
    for (int row = 0; row < rig.height; ++row)
        for (int column = 0; column < rig.width; ++column) {
            const Hit hit = first_hit(scene, left.ray(column, row));
            if (hit.surface == Surface::sky) continue;
            pair.exact_disparity.at<double>(row, column) = rig.focal_px * rig.baseline_m / hit.depth;
            pair.road.at<std::uint8_t>(row, column) = hit.surface == Surface::road;
        }
}

}  // namespace

StereoPair render(const Scene& scene, const Rig& rig, const Pose& pose, const SensorNoise& noise) {
    const Camera left{rig, camera_to_world(pose), pose.position, 0.0};
    const Camera right{rig, left.to_world, pose.position, rig.baseline_m};
    StereoPair pair;
    pair.padding = rig.disparity_range;
    pair.left = render_image(scene, left, pair.padding, 1.0, noise.standard_deviation, Lcg(mix(noise.seed, 1)));
    pair.right = render_image(scene, right, pair.padding, noise.right_gain, noise.standard_deviation,
                              Lcg(mix(noise.seed, 2)));
    render_truth(scene, left, pair);
    return pair;
}

}  // namespace fixtures
