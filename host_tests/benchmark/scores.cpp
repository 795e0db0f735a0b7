#include "scores.hpp"

#include <numeric>

namespace benchmark {

Pose pose_of(const roadpose_pose_t& pose) {
    const double degrees_per_urad = 180e-6 / std::acos(-1.0);
    return {pose.pitch_urad * degrees_per_urad, pose.roll_urad * degrees_per_urad, pose.height_um * 1e-6};
}

void Score::add(const roadpose_pose_t& pose, const recording_truth_t& truth) {
    const bool no_road = truth.known && !truth.road;
    ++(no_road ? no_road_status : road_status)[pose.status];
    if (pose.status != ROADPOSE_STATUS_OK || no_road) return;
    const Pose found = pose_of(pose);
    if (truth.known) {
        errors.add(found, {truth.pitch_deg, truth.roll_deg, truth.height_m});
        return;
    }
    spread.add(found, {0, 0, 0});
    if (last_unknown_) jumps.add(found, *last_unknown_);
    last_unknown_ = found;
}

int Score::road_frames() const { return std::accumulate(road_status.begin(), road_status.end(), 0); }
int Score::no_road_frames() const { return std::accumulate(no_road_status.begin(), no_road_status.end(), 0); }

}  // namespace benchmark
