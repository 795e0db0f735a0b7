// roadpose-figure-scenes left OUT NAME FRAME      left image of a frame of the full fixture set, OUT/NAME-FRAME.png
// roadpose-figure-scenes rolls OUT                a recording of one and the same street under several rolls
// The recordings themselves hold no images; the generator renders these again from the same seeds.
#include <opencv2/imgcodecs.hpp>

#include <cstdio>
#include <exception>
#include <string>

#include "ground_truth.hpp"
#include "hashing.hpp"
#include "matcher.hpp"
#include "recording.hpp"
#include "recording_sets.hpp"
#include "renderer.hpp"
#include "street.hpp"

namespace {

using namespace fixtures;

// As roadpose-make-fixtures --full seeds a recording.
std::uint64_t seed_of_full(const std::string& name) {
    std::uint64_t seed = 2;
    for (const char letter : name) seed = mix(seed, static_cast<unsigned char>(letter));
    return seed;
}

const RecordingSet& set_named(const std::string& name) {
    for (const RecordingSet& set : recording_sets())
        if (set.name == name) return set;
    throw std::runtime_error("no recording is called " + name);
}

cv::Mat left_image(const StereoPair& pair) { return pair.left.colRange(pair.padding, pair.left.cols); }

void write_left(const std::string& out, const std::string& name, int frame) {
    const RecordingSet& set = set_named(name);
    const FrameRecipe recipe = set.recipe({frame, set.full_frames, seed_of_full(name)});
    const StereoPair pair = render(recipe.scene, set.rig, recipe.pose, recipe.noise);
    cv::imwrite(out + "/" + name + "-" + std::to_string(frame) + ".png", left_image(pair));
}

void write_rolls(const std::string& out) {
    const Rig rig;
    RecordingWriter writer(out, rig);
    int index = 0;
    for (const double roll_deg : {0.0, 5.0, 10.0, 15.0, 20.0}) {
        Lcg layout(7);
        const Scene scene = street({}, layout);
        Pose pose;
        pose.pitch = radians(2.0), pose.roll = radians(roll_deg), pose.position = {0.0, 0.0, 1.5};
        const StereoPair pair = render(scene, rig, pose, {});
        writer.add_road_frame(match(pair, rig, Matcher::semi_global), pair.road, true_road_plane(scene.road, pose), "street");
        cv::imwrite(out + "/left-" + std::to_string(index++) + ".png", left_image(pair));
        std::fprintf(stderr, "\r  one street under several rolls: %d of 5 ", index);
    }
    std::fputc('\n', stderr);
}

int run(int argc, char** argv) {
    const std::string what = argc > 2 ? argv[1] : "";
    if (what == "rolls" && argc == 3) return write_rolls(argv[2]), 0;
    if (what != "left" || argc != 5) {
        std::fputs("usage: roadpose-figure-scenes left OUT NAME FRAME | rolls OUT\n", stderr);
        return 2;
    }
    return write_left(argv[2], argv[3], std::stoi(argv[4])), 0;
}

}  // namespace

int main(int argc, char** argv) {
    cv::setNumThreads(1);
    try {
        return run(argc, argv);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "roadpose-figure-scenes: %s\n", error.what());
        return 1;
    }
}
