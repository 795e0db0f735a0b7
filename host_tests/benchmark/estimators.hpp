// The estimators that the tables compare, and one frame run through one of them.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "frame.hpp"
#include "roadpose/roadpose.h"

namespace benchmark {

struct Estimator {
    std::string name;
    roadpose_settings_t settings;
    double roll_limit_deg;  // counts only frames with less true roll; 0 = all
};

std::vector<Estimator> compared_estimators();  // the first is the default
std::vector<Estimator> shares_of_points();     // the paper's table: 100, 50, 25, 10, 5, 1 %, refined and not

// An instance for one recording and one estimator. Throws std::runtime_error where the library refuses the rig.
class Runner {
public:
    Runner(const recording_t& recording, const roadpose_settings_t& settings);
    roadpose_pose_t run(const Frame& frame);

private:
    std::unique_ptr<roadpose_t> instance_;
};

}  // namespace benchmark
