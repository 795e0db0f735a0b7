// roadpose-make-fixtures OUT_DIR [--full] [--only NAME]: renders, matches and writes the recordings, and measures the
// matcher.
#include <opencv2/core.hpp>

#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "ground_truth.hpp"
#include "hashing.hpp"
#include "matcher.hpp"
#include "recording.hpp"
#include "recording_sets.hpp"
#include "renderer.hpp"

namespace {

using namespace fixtures;

struct Options {
    std::filesystem::path out_dir;
    std::string only;
    bool full = false;
};

bool parse(int argc, char** argv, Options& options) {
    for (int i = 1; i < argc; ++i) {
        const std::string argument = argv[i];
        if (argument == "--full") options.full = true;
        else if (argument == "--only" && i + 1 < argc) options.only = argv[++i];
        else if (!argument.empty() && argument[0] != '-' && options.out_dir.empty()) options.out_dir = argument;
        else return false;
    }
    return !options.out_dir.empty();
}

std::uint64_t seed_of(const std::string& name, bool full) {
    std::uint64_t seed = full ? 2 : 1;
    for (const char letter : name) seed = mix(seed, static_cast<unsigned char>(letter));
    return seed;
}

// Means over the frames of one recording that show a road.
struct Summary {
    int frames = 0;
    FrameCheck sum;

    void add(const FrameCheck& check) {
        ++frames;
        sum.valid_share += check.valid_share;
        sum.bias_px += check.bias_px;
        sum.noise_px += check.noise_px;
        sum.outlier_share += check.outlier_share;
        sum.matched_fit.pitch_deg += std::abs(check.matched_fit.pitch_deg);
        sum.matched_fit.roll_deg += std::abs(check.matched_fit.roll_deg);
        sum.matched_fit.height_mm += std::abs(check.matched_fit.height_mm);
    }
    void print(const RecordingSet& set) const {
        if (frames == 0) return;
        const double n = frames;
        std::printf("SUMMARY %-14s %-19s frames %2d valid %5.1f %% bias %+.3f px noise %.3f px outliers %5.2f %% "
                    "LS mean abs error: pitch %.4f deg roll %.4f deg height %.2f mm\n",
                    set.name.c_str(), matcher_name(set.matcher), frames, 100 * sum.valid_share / n, sum.bias_px / n,
                    sum.noise_px / n, 100 * sum.outlier_share / n, sum.matched_fit.pitch_deg / n,
                    sum.matched_fit.roll_deg / n, sum.matched_fit.height_mm / n);
    }
};

void make_frame(const RecordingSet& set, const FrameIndex& index, RecordingWriter& writer, Summary& summary) {
    const FrameRecipe recipe = set.recipe(index);
    const StereoPair pair = render(recipe.scene, set.rig, recipe.pose, recipe.noise);
    cv::Mat disparity = match(pair, set.rig, set.matcher);
    if (recipe.damage) recipe.damage(disparity);
    std::printf("%-14s %2d/%2d %-15s ", set.name.c_str(), index.frame + 1, index.count, recipe.scene_name.c_str());
    if (recipe.scene.road.present) {
        const RoadPlane truth = true_road_plane(recipe.scene.road, recipe.pose);
        const FrameCheck check = check_frame(pair, disparity, set.rig, truth, recipe.scene.road.crown != 0.0);
        summary.add(check);
        writer.add_road_frame(disparity, pair.road, truth, recipe.scene_name);
        std::printf("%+7.3f %+7.3f %.3f  %s\n", degrees(truth.pitch()), degrees(truth.roll()), truth.height,
                    to_text(check).c_str());
    } else {
        writer.add_frame_without_road(disparity, recipe.scene_name);
        std::printf("%.1f %% valid\n", 100.0 * cv::countNonZero(disparity) / static_cast<double>(disparity.total()));
    }
    std::fflush(stdout);
}

void make_recording(const RecordingSet& set, const Options& options) {
    const int frames = options.full ? set.full_frames : set.committed_frames;
    if (frames == 0) return;
    RecordingWriter writer(options.out_dir / set.name, set.rig);
    Summary summary;
    for (int frame = 0; frame < frames; ++frame)
        make_frame(set, {frame, frames, seed_of(set.name, options.full)}, writer, summary);
    summary.print(set);
}

int run(const Options& options) {
    bool found = false;
    std::printf("OpenCV %s\ntruth: pitch_deg roll_deg height_m; %s\n", CV_VERSION, header_of_check().c_str());
    for (const RecordingSet& set : recording_sets()) {
        if (!options.only.empty() && options.only != set.name) continue;
        found = true;
        make_recording(set, options);
    }
    if (!found) std::fprintf(stderr, "roadpose-make-fixtures: no recording is called %s\n", options.only.c_str());
    return found ? 0 : 2;
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    if (!parse(argc, argv, options)) {
        std::fprintf(stderr, "usage: roadpose-make-fixtures OUT_DIR [--full] [--only NAME]\n");
        return 2;
    }
    cv::setNumThreads(1);
    try {
        return run(options);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "roadpose-make-fixtures: %s\n", error.what());
        return 1;
    }
}
