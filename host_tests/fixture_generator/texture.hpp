// Procedural textures, anchored in metres on a surface, and the grey value a pixel of known footprint sees of them.
#pragma once
#include <opencv2/core.hpp>

#include <cstdint>

namespace fixtures {

enum class Pattern { plain, lane_markings, windows, vehicle_rear };

struct Texture {
    std::uint32_t seed = 1;
    double base_grey = 100.0;
    double contrast = 1.0;             // 1 = ordinary; scales every octave
    double finest_wavelength = 0.008;  // metres
    int octaves = 8;                   // each twice as long as the one before
    Pattern pattern = Pattern::plain;
    double marking_offset = 1.75;      // lane_markings: lines at ± this many metres
};

// What one ray covers on the surface: the two edges of its (sub)pixel, in texture coordinates, metres.
struct Footprint {
    cv::Vec2d along_u;
    cv::Vec2d along_v;
};

double grey_value(const Texture& texture, const cv::Vec2d& point, const Footprint& footprint);

}  // namespace fixtures
