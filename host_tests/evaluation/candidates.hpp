// Everything that is compared: our own settings, the paper's other two methods, the peers, the oracle.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "geometry.hpp"
#include "input.hpp"

namespace evaluation {

using benchmark::DisparityPlane;
using benchmark::Pose;

struct Answer {
    std::string status = "ok";  // "ok", or one word that says why there is no pose
    bool has_roll = true;
    Pose pose{};
};

struct Candidate {
    std::string name;
    std::function<Answer(const Input&)> estimate;
};

// Mounting limits, the same for all: pitch -10...+15 degrees, roll +-25, height 0.3...4 m.
bool is_within_limits(const Pose& pose);
Answer no_road();
Answer answer_of(const DisparityPlane& plane, const recording_rig_t& rig);

std::vector<Candidate> peer_candidates(const recording_t& recording);
std::vector<Candidate> all_candidates(const recording_t& recording);

}  // namespace evaluation
