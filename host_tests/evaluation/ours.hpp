// The library's candidates.
#pragma once
#include <memory>
#include <vector>

#include "candidates.hpp"
#include "roadpose/roadpose.h"

namespace evaluation {

// What is told to the library that is not true, to see how much it matters.
struct Disturbance {
    double offset_px = 0;       // matcher bias
    double focal_factor = 1;
    double baseline_factor = 1;
};

class Ours {
public:
    Ours(const recording_t& recording, const roadpose_settings_t& settings, const Disturbance& disturbance = {});
    roadpose_pose_t process(const std::vector<std::uint16_t>& native);
    // Goes no further than Method 2's pairs: the frame's later work overwrites them.
    void draw_pairs(const std::vector<std::uint16_t>& native);
    const roadpose_t& instance() const { return *instance_; }

private:
    roadpose_frame_t view_of(const std::vector<std::uint16_t>& native) const;

    std::unique_ptr<roadpose_t> instance_;
    roadpose_rig_t rig_;
};

roadpose_settings_t settings_of(int method, bool refine, int points_percent);
Answer answer_of(const roadpose_pose_t& pose);
std::vector<Candidate> our_candidates(const recording_t& recording);

}  // namespace evaluation
