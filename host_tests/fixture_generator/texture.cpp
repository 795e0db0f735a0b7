#include "texture.hpp"

#include <algorithm>
#include <cmath>

#include "hashing.hpp"

namespace fixtures {
namespace {

constexpr double octave_amplitude = 34.0;  // grey levels, peak to peak, of one octave at contrast 1
constexpr int max_samples = 6;             // along the long side of a footprint

double smooth(double t) { return t * t * (3.0 - 2.0 * t); }

double unit_step(double low, double high, double x) { return std::clamp((x - low) / (high - low), 0.0, 1.0); }

// Value noise, −0.5…0.5, one lattice cell per unit.
double value_noise(double x, double y, std::uint32_t seed) {
    const double fx = std::floor(x), fy = std::floor(y);
    const auto ix = static_cast<std::int32_t>(fx), iy = static_cast<std::int32_t>(fy);
    const double tx = smooth(x - fx), ty = smooth(y - fy);
    const double top = lattice_value(ix, iy, seed) * (1 - tx) + lattice_value(ix + 1, iy, seed) * tx;
    const double bottom = lattice_value(ix, iy + 1, seed) * (1 - tx) + lattice_value(ix + 1, iy + 1, seed) * tx;
    return top * (1 - ty) + bottom * ty - 0.5;
}

// The footprint as a thin rectangle: sampled along its long side, blurred to its short side.
struct FilterShape {
    cv::Vec2d long_side;
    double short_length;
    double spacing;  // between two samples
    int samples;
};

FilterShape filter_shape(const Footprint& footprint) {
    const double u = cv::norm(footprint.along_u), v = cv::norm(footprint.along_v);
    const double area = std::abs(footprint.along_u[0] * footprint.along_v[1] - footprint.along_u[1] * footprint.along_v[0]);
    const double longest = std::max({u, v, 1e-9});
    FilterShape shape;
    shape.long_side = u > v ? footprint.along_u : footprint.along_v;
    shape.short_length = std::max(area / longest, 1e-6);
    shape.samples = std::clamp(static_cast<int>(std::ceil(longest / shape.short_length)), 1, max_samples);
    shape.spacing = longest / shape.samples;
    return shape;
}

// Grain finer than a pixel is invisible; grain finer than the sample spacing averages out as 1/√n, as it would in a
// real pixel.
double octave_weight(double wavelength, const FilterShape& shape) {
    const double visible = unit_step(0.6, 1.4, wavelength / shape.short_length);
    return visible * std::sqrt(std::min(1.0, wavelength / shape.spacing));
}

double noise_sum(const Texture& texture, const cv::Vec2d& point, const FilterShape& shape) {
    double sum = 0.0, wavelength = texture.finest_wavelength;
    for (int octave = 0; octave < texture.octaves; ++octave, wavelength *= 2.0) {
        const double weight = octave_weight(wavelength, shape);
        if (weight <= 0.0) continue;
        const std::uint32_t seed = texture.seed * 0x2545F491u + static_cast<std::uint32_t>(octave) * 0x632BE5ABu;
        sum += weight * value_noise(point[0] / wavelength, point[1] / wavelength, seed);
    }
    return sum * octave_amplitude * texture.contrast;
}

// How much of a soft stripe of this half width lies under the filter.
double stripe(double distance, double half_width, double blur) {
    return unit_step(-0.5, 0.5, (half_width - std::abs(distance)) / std::max(blur, 1e-3));
}

double lane_markings(const Texture& texture, const cv::Vec2d& p, double blur) {
    const double line = stripe(std::abs(p[1]) - texture.marking_offset, 0.06, blur);
    const double along = p[0] - 9.0 * std::floor(p[0] / 9.0);
    const double dash = p[1] < 0 ? 1.0 : stripe(along - 1.5, 1.5, 0.05);
    return 85.0 * line * dash;
}

double windows(const cv::Vec2d& p, double blur) {
    const double x = p[0] - 2.6 * std::floor(p[0] / 2.6) - 1.3;
    const double y = p[1] - 3.0 * std::floor(p[1] / 3.0) - 1.6;
    return -45.0 * stripe(x, 0.6, blur) * stripe(y, 0.8, blur);
}

double vehicle_rear(const cv::Vec2d& p, double blur) {
    const double door = stripe(p[0], 0.015, blur) + stripe(p[0] - 0.9, 0.02, blur) + stripe(p[0] + 0.9, 0.02, blur);
    const double bars = stripe(p[1] + 0.55, 0.04, blur) + stripe(p[1] - 0.4, 0.02, blur);
    return -40.0 * door - 30.0 * bars;
}

double pattern_value(const Texture& texture, const cv::Vec2d& point, double blur) {
    switch (texture.pattern) {
        case Pattern::lane_markings: return lane_markings(texture, point, blur);
        case Pattern::windows: return windows(point, blur);
        case Pattern::vehicle_rear: return vehicle_rear(point, blur);
        case Pattern::plain: break;
    }
    return 0.0;
}

}  // namespace

double grey_value(const Texture& texture, const cv::Vec2d& point, const Footprint& footprint) {
    const FilterShape shape = filter_shape(footprint);
    double sum = 0.0;
    for (int i = 0; i < shape.samples; ++i) {
        const cv::Vec2d sample = point + shape.long_side * ((i + 0.5) / shape.samples - 0.5);
        sum += noise_sum(texture, sample, shape) + pattern_value(texture, sample, shape.short_length);
    }
    return texture.base_grey + sum / shape.samples;
}

}  // namespace fixtures
