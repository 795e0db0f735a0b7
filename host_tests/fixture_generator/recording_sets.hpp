// What is in each recording: for every frame the scene, the pose and the damage, drawn from a seed.
#pragma once
#include <opencv2/core.hpp>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "matcher.hpp"
#include "renderer.hpp"
#include "rig.hpp"
#include "scene.hpp"

namespace fixtures {

struct FrameRecipe {
    Scene scene;
    Pose pose;
    std::string scene_name;
    SensorNoise noise;
    std::function<void(cv::Mat&)> damage;  // of the finished disparity map; may be empty
};

struct FrameIndex {
    int frame;
    int count;
    std::uint64_t recording_seed;
    double fraction() const { return count > 1 ? static_cast<double>(frame) / (count - 1) : 0.5; }
    std::uint64_t frame_seed() const;
};

struct RecordingSet {
    std::string name;
    int committed_frames;  // 0 = only with --full
    int full_frames;
    Rig rig;
    Matcher matcher;
    FrameRecipe (*recipe)(const FrameIndex&);
};

const std::vector<RecordingSet>& recording_sets();

}  // namespace fixtures
