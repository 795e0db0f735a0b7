#include "samples.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace evaluation {
namespace {

constexpr double half_width_m = 3.0, range_m = 25.0;

// Of the road at this distance aside of the optical axis, pixels: no farther than the crop reaches.
double least_disparity(const recording_rig_t& rig, double x) {
    return std::max(std::abs(x) * rig.baseline_m / half_width_m, rig.focal_px * rig.baseline_m / range_m);
}

}  // namespace

Samples::Samples(const recording_rig_t& rig, bool cropped)
    : rig_(rig), least_(static_cast<std::size_t>(rig.width)),
      offset_(static_cast<int>(std::lround(rig.disparity_offset_px * rig.disparity_scale))) {
    if (rig.invalid + offset_ > 0) throw std::runtime_error("the peers want no match to be below every disparity");
    for (int u = 0; u < rig.width; ++u) {
        const double least_px = cropped ? least_disparity(rig, u - rig.cu_px) : 0;
        const double sample = std::ceil((least_px - rig.disparity_offset_px) * rig.disparity_scale);
        least_[u] = std::max(static_cast<int>(sample), 1 - offset_);
    }
}

SampleReader Samples::reader() const {
    const int fraction_bits = static_cast<int>(std::lround(std::log2(rig_.disparity_scale)));
    return {least_.data(), offset_, fraction_bits, 1 / rig_.disparity_scale, rig_.disparity_offset_px};
}

}  // namespace evaluation
