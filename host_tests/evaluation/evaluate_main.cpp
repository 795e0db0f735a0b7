// roadpose-evaluate RECORDING... >results.csv: every candidate on every frame, with its time. One line a candidate and
// frame. All run in this one process, on one core, each frame by all before the next one: they see the same machine.
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <exception>
#include <vector>

#include "candidates.hpp"
#include "measurement.hpp"

namespace evaluation {
namespace {

constexpr std::size_t repeats = 5;
constexpr double long_us = 20000;  // what takes longer is run once: a chance delay is small beside it

// Processor time of this process: what others do on the machine meanwhile is not in it.
double now_us() { return 1e6 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

Answer timed(const Candidate& candidate, const Input& input, double& median_us) {
    std::vector<double> times;
    Answer answer;
    while (times.size() < repeats && (times.empty() || times.front() < long_us)) {
        const double start = now_us();
        answer = candidate.estimate(input);
        times.push_back(now_us() - start);
    }
    std::sort(times.begin(), times.end());
    median_us = times[times.size() / 2];
    return answer;
}

void print_pose(bool known, bool has_roll, const Pose& pose) {
    if (!known) std::printf(",,,");
    else if (!has_roll) std::printf(",%.6f,,%.6f", pose.pitch_deg, pose.height_m);
    else std::printf(",%.6f,%.6f,%.6f", pose.pitch_deg, pose.roll_deg, pose.height_m);
}

void print_line(const recording_t& recording, int index, const Candidate& candidate, const Input& input) {
    double median_us;
    const Answer answer = timed(candidate, input, median_us);
    const recording_truth_t& truth = input.frame.truth;
    std::printf("%s,%d,%s,%d", recording.name, index, truth.scene, truth.known ? truth.road : -1);
    print_pose(truth.known && truth.road, true, {truth.pitch_deg, truth.roll_deg, truth.height_m});
    std::printf(",\"%s\",%s", candidate.name.c_str(), answer.status.c_str());
    print_pose(answer.status == "ok", answer.has_roll, answer.pose);
    std::printf(",%.1f\n", median_us);
}

void evaluate(const recording_t& recording) {
    const std::vector<Candidate> candidates = all_candidates(recording);
    for (int index = 0; index < recording.frames; ++index) {
        const Input input = load_input(recording, index);
        for (const Candidate& candidate : candidates) print_line(recording, index, candidate, input);
        std::fprintf(stderr, "\r  %s: frame %d of %d ", recording.name, index + 1, recording.frames);
        std::fflush(stderr);
    }
    std::fputc('\n', stderr);
}

}  // namespace
}  // namespace evaluation

int main(int argc, char** argv) {
    cv::setNumThreads(1);
    std::puts("recording,frame,scene,road,true_pitch,true_roll,true_height,candidate,status,pitch,roll,height,time_us");
    try {
        for (int i = 1; i < argc; ++i) {
            const benchmark::OpenRecording open(argv[i]);
            evaluation::evaluate(open.recording);
        }
    } catch (const std::exception& error) {
        std::fprintf(stderr, "roadpose-evaluate: %s\n", error.what());
        return 3;
    }
    return argc > 1 ? 0 : 2;
}
