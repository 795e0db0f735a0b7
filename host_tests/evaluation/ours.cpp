#include "ours.hpp"

#include <cmath>
#include <stdexcept>

#include "scores.hpp"

extern "C" {
#include "frame_work.h"  // the names of the phases
}

namespace evaluation {
namespace {

Candidate candidate(const recording_t& recording, const std::string& name, const roadpose_settings_t& settings) {
    const auto ours = std::make_shared<Ours>(recording, settings);
    return {name, [ours](const Input& input) { return answer_of(ours->process(input.native)); }};
}

void disturb(roadpose_rig_t& rig, roadpose_disparity_format_t& format, const Disturbance& disturbance) {
    rig.focal_millipx = static_cast<std::int32_t>(std::lround(rig.focal_millipx * disturbance.focal_factor));
    rig.baseline_um = static_cast<std::int32_t>(std::lround(rig.baseline_um * disturbance.baseline_factor));
    format.offset_millipx += static_cast<std::int32_t>(std::lround(1000 * disturbance.offset_px));
    format.byte_order = ROADPOSE_BYTES_NATIVE;
}

roadpose_settings_t without_corridor(roadpose_settings_t settings, bool keep_obstacles) {
    settings.corridor_half_width_mm = 0;
    settings.corridor_range_mm = 0;
    if (keep_obstacles) settings.obstacle_height_mm = 0;
    return settings;
}

// Refuses as little as the library can be told to: what a method would say where it should not be asked.
roadpose_settings_t accepting_all(roadpose_settings_t settings) {
    settings.points_min = 16;
    settings.support_min_permille = 0;
    settings.range_min_mm = 0;
    return settings;
}

}  // namespace

Ours::Ours(const recording_t& recording, const roadpose_settings_t& settings, const Disturbance& disturbance)
    : instance_(std::make_unique<roadpose_t>()) {
    roadpose_disparity_format_t format;
    if (!recording_describe(&recording, &rig_, &format)) throw std::runtime_error("disparity_scale is no power of two");
    disturb(rig_, format, disturbance);
    const roadpose_result_t result = roadpose_init(instance_.get(), &rig_, &format, &settings);
    if (result != ROADPOSE_OK) throw std::runtime_error("roadpose_init says " + std::to_string(result));
}

roadpose_frame_t Ours::view_of(const std::vector<std::uint16_t>& native) const {
    roadpose_frame_t view{};
    view.samples = native.data();
    view.stride_bytes = 2u * rig_.width_px;
    view.width_px = rig_.width_px;
    view.height_px = rig_.height_px;
    return view;
}

roadpose_pose_t Ours::process(const std::vector<std::uint16_t>& native) {
    const roadpose_frame_t view = view_of(native);
    roadpose_pose_t pose{};
    const roadpose_result_t result = roadpose_process(instance_.get(), &view, &pose);
    if (result != ROADPOSE_OK) throw std::runtime_error("roadpose_process says " + std::to_string(result));
    return pose;
}

void Ours::draw_pairs(const std::vector<std::uint16_t>& native) {
    const roadpose_frame_t view = view_of(native);
    roadpose_result_t result = roadpose_frame_begin(instance_.get(), &view);
    while (result >= ROADPOSE_OK && instance_->phase != PHASE_SLOPE) {
        result = roadpose_frame_slice(instance_.get());
        if (result == ROADPOSE_OK) throw std::runtime_error("no pairs in this frame");
    }
}

roadpose_settings_t settings_of(int method, bool refine, int points_percent) {
    roadpose_settings_t settings;
    roadpose_settings_default(&settings);
    settings.method = static_cast<std::uint8_t>(method);
    settings.refine = refine;
    settings.points_percent = static_cast<std::uint8_t>(points_percent);
    return settings;
}

Answer answer_of(const roadpose_pose_t& pose) {
    return {roadpose_status_word(pose.status), (pose.observed & ROADPOSE_OBSERVED_ROLL) != 0, benchmark::pose_of(pose)};
}

std::vector<Candidate> our_candidates(const recording_t& recording) {
    std::vector<Candidate> all = {
        candidate(recording, "roadpose", settings_of(2, true, 100)),
        candidate(recording, "Method 2 alone", settings_of(2, false, 100)),
        candidate(recording, "Method 1 + refinement", settings_of(1, true, 100)),
        candidate(recording, "Method 1 alone", settings_of(1, false, 100)),
        candidate(recording, "Method 1 alone, v-disparity, no corridor", without_corridor(settings_of(1, false, 100), true)),
        candidate(recording, "Method 1 alone, v-disparity-free, no corridor",
                  without_corridor(settings_of(1, false, 100), false)),
        candidate(recording, "Method 1 alone, nothing refused", accepting_all(settings_of(1, false, 100))),
        candidate(recording, "Method 2 alone, no corridor", without_corridor(settings_of(2, false, 100), false)),
    };
    for (const int percent : {50, 25, 10, 5, 1})
        for (const bool refine : {false, true})
            all.push_back(candidate(recording, "points " + std::to_string(percent) + (refine ? " refined" : ""),
                                    settings_of(2, refine, percent)));
    return all;
}

}  // namespace evaluation
