// roadpose-accuracy-gate KIND RECORDING...: exit status 1 when the results over all these recordings break the limits
// of their kind. The limits are the accuracy that the project has promised; the tests run this on every fixture.
#include <cstdio>
#include <cstring>
#include <exception>
#include <limits>
#include <stdexcept>

#include "measurement.hpp"

namespace benchmark {
namespace {

const double none = std::numeric_limits<double>::infinity();

struct AxisLimits {
    double mean_absolute, mean, deviation, worst;
};

struct Limits {
    const char* kind;
    AxisLimits pitch, roll, height;  // degrees, degrees, millimetres
    double accepted;                 // smallest share of the frames with a road
    double oracle_ratio;             // of the mean absolute errors, to least squares on the true road
    double jump_deg;
    bool methods_beat_the_paper;     // each method alone, where it applies
};

const Limits all_limits[] = {
    {"easy", {0.03, none, none, 0.5}, {0.015, none, none, 0.5}, {1.5, none, none, 50}, 0.8, 1.2, none, true},
    {"hard", {0.05, none, none, 0.5}, {0.08, none, none, 0.5}, {5, none, none, 50}, 0.8, none, none, false},
    {"small-profile", {0.05, none, none, 0.5}, {0.03, none, none, 0.5}, {3, none, none, 50}, 0.8, none, none, false},
    {"without-road", {none, none, none, 0.5}, {none, none, none, 0.5}, {none, none, none, 50}, 0, none, none, false},
    {"street-lidar", {none, 0.15, 0.06, none}, {none, 0.06, 0.13, none}, {none, 40, 8, none}, 0.8, none, none, false},
    {"straight-motion", {none, none, none, none}, {none, none, none, none}, {none, none, none, none}, 1, none, 0.5, false},
};

int broken = 0;

void hold(const char* what, double value, double limit) {
    if (limit == none) return;
    const bool ok = value <= limit;
    std::printf("%s %s: %.4f, at most %.4f\n", ok ? "  ok    " : "  BROKEN", what, value, limit);
    broken += !ok;
}

void hold_axis(const std::string& axis, const Errors& errors, const AxisLimits& limits) {
    hold((axis + ", mean absolute error").c_str(), errors.mean_absolute(), limits.mean_absolute);
    hold((axis + ", mean error").c_str(), std::abs(errors.mean()), limits.mean);
    hold((axis + ", standard deviation").c_str(), errors.deviation(), limits.deviation);
    hold((axis + ", worst").c_str(), errors.worst(), limits.worst);
}

void hold_acceptance(const Score& score, double accepted) {
    if (score.no_road_frames() > 0) hold("frames without road that were accepted", score.no_road_status[0], 0);
    if (score.road_frames() > 0)
        hold("share of road frames refused", 1 - static_cast<double>(score.road_status[0]) / score.road_frames(),
             1 - accepted + 1e-9);
}

void hold_ratio(const char* what, const Errors& ours, const Errors& oracle, double ratio) {
    if (oracle.count() > 0) hold(what, ours.mean_absolute() / oracle.mean_absolute(), ratio);
}

void hold_oracle(const PoseErrors& ours, const PoseErrors& oracle, double ratio) {
    hold_ratio("pitch, ratio to least squares on the true road", ours.pitch, oracle.pitch, ratio);
    hold_ratio("roll, ratio to least squares on the true road", ours.roll, oracle.roll, ratio);
    hold_ratio("height, ratio to least squares on the true road", ours.height, oracle.height, ratio);
}

void hold_paper(const Row& row, bool roll) {
    hold((row.name + ", no accepted frame").c_str(), row.score.errors.count() == 0, 0);
    if (row.score.errors.count() == 0) return;
    hold((row.name + ", pitch, mean absolute error").c_str(), row.score.errors.pitch.mean_absolute(), 0.20);
    if (roll) hold((row.name + ", roll, mean absolute error").c_str(), row.score.errors.roll.mean_absolute(), 0.38);
    hold((row.name + ", height, mean absolute error").c_str(), row.score.errors.height.mean_absolute(), 12);
}

void hold_score(const Score& score, const Limits& limits) {
    hold_acceptance(score, limits.accepted);
    hold_axis("pitch", score.errors.pitch, limits.pitch);
    hold_axis("roll", score.errors.roll, limits.roll);
    hold_axis("height", score.errors.height, limits.height);
    hold("pitch, largest jump", score.jumps.pitch.worst(), limits.jump_deg);
    hold("roll, largest jump", score.jumps.roll.worst(), limits.jump_deg);
}

// What needs many frames to be more than chance: over all recordings together.
void hold_together(const Results& results, const Limits& limits) {
    std::puts("all together");
    if (limits.oracle_ratio != none)
        hold_oracle(results.rows[0].score.errors, results.oracles[least_squares].errors, limits.oracle_ratio);
    if (limits.methods_beat_the_paper) {
        hold_paper(results.rows[1], true);   // Method 2 alone
        hold_paper(results.rows[4], false);  // Method 1 alone, where roll is negligible
    }
}

void hold_all(const Limits& limits, int count, char** folders) {
    Results together;
    for (int i = 0; i < count; ++i) {
        const OpenRecording open(folders[i]);
        const Results results = measure(open.recording, compared_estimators(), true);
        std::printf("%s, %d frames, limits: %s\n", open.recording.name, open.recording.frames, limits.kind);
        hold_score(results.rows.front().score, limits);
        together.add(results);
    }
    hold_together(together, limits);
}

const Limits& limits_of(const char* kind) {
    for (const Limits& limits : all_limits)
        if (std::strcmp(limits.kind, kind) == 0) return limits;
    throw std::runtime_error(std::string("no such kind: ") + kind);
}

}  // namespace
}  // namespace benchmark

int main(int argc, char** argv) {
    if (argc < 3) {
        std::fprintf(stderr, "usage: roadpose-accuracy-gate easy|hard|without-road|street-lidar|straight-motion RECORDING...\n");
        return 2;
    }
    try {
        benchmark::hold_all(benchmark::limits_of(argv[1]), argc - 2, argv + 2);
    } catch (const std::exception& problem) {
        std::fprintf(stderr, "roadpose-accuracy-gate: %s\n", problem.what());
        return 3;
    }
    return benchmark::broken > 0 ? 1 : 0;
}
