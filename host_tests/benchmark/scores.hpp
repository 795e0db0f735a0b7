// What an estimator did over one recording.
#pragma once
#include <array>
#include <optional>

#include "frame.hpp"
#include "geometry.hpp"
#include "roadpose/pose.h"
#include "statistics.hpp"

namespace benchmark {

struct PoseErrors {
    Errors pitch, roll, height;  // degrees, degrees, millimetres
    void add(const Pose& pose, const Pose& truth) {
        pitch.add(pose.pitch_deg - truth.pitch_deg);
        roll.add(pose.roll_deg - truth.roll_deg);
        height.add(1000 * (pose.height_m - truth.height_m));
    }
    void add(const PoseErrors& more) {
        pitch.add(more.pitch);
        roll.add(more.roll);
        height.add(more.height);
    }
    int count() const { return pitch.count(); }
};

Pose pose_of(const roadpose_pose_t& pose);

class Score {
public:
    void add(const roadpose_pose_t& pose, const recording_truth_t& truth);

    PoseErrors errors;  // accepted frames with a true pose
    PoseErrors spread;  // accepted frames whose pose is not known, against zero
    PoseErrors jumps;   // from one accepted frame to the next, where the pose is not known
    std::array<int, ROADPOSE_STATUS_COUNT> road_status{};     // frames with a road (or where it is not known)
    std::array<int, ROADPOSE_STATUS_COUNT> no_road_status{};  // frames that truly have none
    int road_frames() const;
    int no_road_frames() const;

private:
    std::optional<Pose> last_unknown_;
};

}  // namespace benchmark
