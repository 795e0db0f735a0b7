// roadpose-sensitivity RECORDING... >sensitivity.csv: the default estimator on frames with a known pose, while one thing
// it is told, or sees, is wrong. One line a frame, kind and amount.
#include <cstdio>
#include <exception>

#include "measurement.hpp"
#include "ours.hpp"
#include "random_numbers.hpp"

namespace evaluation {
namespace {

struct Case {
    const char* kind;
    double amount;  // px or percent
    Disturbance disturbance;
    double noise_px;
};

std::vector<Case> cases() {
    std::vector<Case> all;
    for (const double px : {-0.3, -0.2, -0.1, -0.05, 0.0, 0.05, 0.1, 0.2, 0.3}) all.push_back({"bias", px, {px, 1, 1}, 0});
    for (const double px : {0.0, 0.1, 0.2, 0.4, 0.6, 0.8, 1.0, 1.5}) all.push_back({"noise", px, {}, px});
    for (const double percent : {-2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0}) {
        all.push_back({"focal", percent, {0, 1 + percent / 100, 1}, 0});
        all.push_back({"baseline", percent, {0, 1, 1 + percent / 100}, 0});
    }
    return all;
}

// Independent from pixel to pixel, on top of the matcher's own.
std::vector<std::uint16_t> with_noise(const Input& input, double sigma_px, std::uint64_t seed) {
    Random random(seed);
    std::vector<std::uint16_t> noisy = input.native;
    for (std::uint16_t& sample : noisy)
        if (sample != static_cast<std::uint16_t>(input.rig().invalid))
            sample = static_cast<std::uint16_t>(
                std::clamp(sample + sigma_px * random.normal() * input.rig().disparity_scale, 1.0, 65535.0));
    return noisy;
}

void print_errors(const Case& tried, const recording_t& recording, int index, const Answer& answer) {
    const recording_truth_t& truth = recording.truth[index];
    std::printf("%s,%g,%s,%d,%s", tried.kind, tried.amount, recording.name, index, answer.status.c_str());
    if (answer.status != "ok") std::puts(",,,");
    else
        std::printf(",%.6f,%.6f,%.6f\n", answer.pose.pitch_deg - truth.pitch_deg, answer.pose.roll_deg - truth.roll_deg,
                    answer.pose.height_m - truth.height_m);
}

void try_frame(const recording_t& recording, int index, const std::vector<Case>& tried_cases) {
    const Input input = load_input(recording, index);
    if (!input.frame.truth.road) return;
    for (const Case& tried : tried_cases) {
        Ours ours(recording, settings_of(2, true, 100), tried.disturbance);
        const bool noisy = tried.noise_px > 0;
        const roadpose_pose_t pose = ours.process(noisy ? with_noise(input, tried.noise_px, 1 + index) : input.native);
        print_errors(tried, recording, index, answer_of(pose));
    }
}

}  // namespace
}  // namespace evaluation

int main(int argc, char** argv) {
    std::puts("kind,amount,recording,frame,status,pitch,roll,height");
    try {
        for (int i = 1; i < argc; ++i) {
            const benchmark::OpenRecording open(argv[i]);
            const std::vector<evaluation::Case> tried = evaluation::cases();
            for (int index = 0; index < open.recording.frames; ++index) {
                evaluation::try_frame(open.recording, index, tried);
                std::fprintf(stderr, "\r  %s: frame %d of %d ", open.recording.name, index + 1, open.recording.frames);
            }
            std::fputc('\n', stderr);
        }
    } catch (const std::exception& error) {
        std::fprintf(stderr, "roadpose-sensitivity: %s\n", error.what());
        return 3;
    }
    return argc > 1 ? 0 : 2;
}
