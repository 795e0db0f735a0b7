#include "corridor.hpp"

#include <cmath>

namespace evaluation {

bool is_in_crop(const recording_rig_t& rig, double x, double disparity) {
    return std::abs(x) * rig.baseline_m <= 3.0 * disparity && rig.focal_px * rig.baseline_m <= 25.0 * disparity;
}

}  // namespace evaluation
