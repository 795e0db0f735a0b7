// The road profile: a robust line in the v-disparity, in double precision.
#pragma once
#include <opencv2/core.hpp>

#include <optional>

#include "recording_file.h"

namespace evaluation {

// d = slope * (v - cv) + intercept
struct Line {
    double slope, intercept;
    double at(double y) const { return slope * y + intercept; }
};

struct Profile {
    double pitch_deg, height_m;
};

constexpr int levels = 256;  // whole disparities; enough for every recording

cv::Mat1w v_disparity(const cv::Mat1f& disparity);                       // rows x levels
Profile profile_of(const Line& line, const recording_rig_t& rig);       // roll taken as zero
bool is_possible(const Line& line, const recording_rig_t& rig);         // within the mounting limits
std::optional<Line> ransac_line(const cv::Mat1w& histogram, const recording_rig_t& rig);
Line least_squares_line(const cv::Mat1w& histogram, const Line& start, double band_px, const recording_rig_t& rig);

}  // namespace evaluation
