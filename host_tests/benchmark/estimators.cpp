#include "estimators.hpp"

#include <stdexcept>

namespace benchmark {
namespace {

Estimator estimator(const std::string& name, int method, bool refine, int percent, double roll_limit_deg = 0) {
    Estimator made{name, {}, roll_limit_deg};
    roadpose_settings_default(&made.settings);
    made.settings.method = static_cast<std::uint8_t>(method);
    made.settings.refine = refine;
    made.settings.points_percent = static_cast<std::uint8_t>(percent);
    return made;
}

}  // namespace

std::vector<Estimator> compared_estimators() {
    return {estimator("Method 2 + refinement (default)", 2, true, 100), estimator("Method 2 alone", 2, false, 100),
            estimator("Method 1 + refinement", 1, true, 100), estimator("Method 1 alone", 1, false, 100),
            estimator("Method 1 alone, true roll under 1°", 1, false, 100, 1.0)};
}

std::vector<Estimator> shares_of_points() {
    std::vector<Estimator> shares;
    for (const int percent : {100, 50, 25, 10, 5, 1})
        for (const bool refine : {false, true})
            shares.push_back(estimator(std::to_string(percent) + " % of the points" + (refine ? ", refined" : ""), 2,
                                       refine, percent));
    return shares;
}

Runner::Runner(const recording_t& recording, const roadpose_settings_t& settings)
    : instance_(std::make_unique<roadpose_t>()) {
    roadpose_rig_t rig;
    roadpose_disparity_format_t format;
    if (!recording_describe(&recording, &rig, &format)) throw std::runtime_error("disparity_scale is no power of two");
    const roadpose_result_t result = roadpose_init(instance_.get(), &rig, &format, &settings);
    if (result != ROADPOSE_OK) throw std::runtime_error("roadpose_init says " + std::to_string(result));
}

roadpose_pose_t Runner::run(const Frame& frame) {
    roadpose_frame_t view{};
    view.samples = frame.samples.data();
    view.stride_bytes = static_cast<std::uint32_t>(2 * frame.rig->width);
    view.width_px = static_cast<std::uint16_t>(frame.rig->width);
    view.height_px = static_cast<std::uint16_t>(frame.rig->height);
    roadpose_pose_t pose{};
    const roadpose_result_t result = roadpose_process(instance_.get(), &view, &pose);
    if (result != ROADPOSE_OK) throw std::runtime_error("roadpose_process says " + std::to_string(result));
    return pose;
}

}  // namespace benchmark
