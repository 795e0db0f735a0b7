// One frame of a recording: the raw samples, the true road pixels, the truth.
#pragma once
#include <cstdint>
#include <vector>

#include "recording_file.h"

namespace benchmark {

struct Frame {
    const recording_rig_t* rig;
    std::vector<std::uint8_t> samples;  // big-endian
    std::vector<std::uint8_t> road;     // 1 = true road; empty where the recording has no mask
    recording_truth_t truth;

    // Disparity in pixels, offset included; 0 = no match.
    double disparity(int u, int v) const {
        const std::size_t at = 2 * (static_cast<std::size_t>(v) * rig->width + u);
        const int sample = samples[at] << 8 | samples[at + 1];
        if (sample == static_cast<int>(rig->invalid)) return 0;
        const double disparity = sample / rig->disparity_scale + rig->disparity_offset_px;
        return disparity > 0 ? disparity : 0;
    }
};

// Throws std::runtime_error where the frame cannot be read.
Frame load_frame(const recording_t& recording, int index);

}  // namespace benchmark
