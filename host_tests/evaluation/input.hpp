// One frame: the raw samples in the machine's byte order, which is what our library and the peers get, and disparities as
// numbers for the comparators and the figures. Bringing the file's bytes into this form is not timed.
#pragma once
#include <opencv2/core.hpp>

#include <cstdint>
#include <vector>

#include "frame.hpp"

namespace evaluation {

using benchmark::Frame;

struct Input {
    Frame frame;
    std::vector<std::uint16_t> native;
    cv::Mat1f disparity;  // pixels; 0 = no match

    const recording_rig_t& rig() const { return *frame.rig; }
};

Input load_input(const recording_t& recording, int index);

}  // namespace evaluation
