// What a double-precision least-squares plane makes of the true road pixels of a frame: the best that the matcher's
// disparities allow a plain fit that is told where the road is.
#pragma once
#include <optional>

#include "frame.hpp"
#include "geometry.hpp"

namespace benchmark {

struct OracleOptions {
    const char* name;
    bool corridor;  // only road within the estimator's default corridor
    bool trimmed;   // fit again twice without what is further than the estimator's final band from the fit
};

// Empty where the frame has no road mask, no truth, or fewer than 100 road pixels with a disparity.
std::optional<Pose> fit_true_road(const Frame& frame, const OracleOptions& options);

}  // namespace benchmark
