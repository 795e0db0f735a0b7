// roadpose-count RECORDING FRAME... : our library, the peers and the pass that a v-disparity begins with, once each on these
// frames, with callgrind counting the instructions of each. Counts do not depend on who else uses the machine. Run it as
//   valgrind --tool=callgrind --instr-atstart=no --callgrind-out-file=OUT roadpose-count RECORDING FRAME...
// Callgrind writes OUT.1, OUT.2 and so on, one for each, in the order of the lines "recording,frame,candidate" on standard
// output.
#include <valgrind/callgrind.h>

#include <cstdio>
#include <exception>

#include "hough_peer.hpp"
#include "measurement.hpp"
#include "ours.hpp"

namespace evaluation {
namespace {

Candidate bare_pass(const recording_t& recording) {
    return {"v-disparity of every pixel", [samples = Samples(recording.rig, false)](const Input& input) {
                return v_disparity_of(input, samples).empty() ? no_road() : Answer{};
            }};
}

std::vector<Candidate> counted_candidates(const recording_t& recording) {
    std::vector<Candidate> all = {our_candidates(recording).front(), bare_pass(recording)};
    for (Candidate& peer : peer_candidates(recording)) all.push_back(std::move(peer));
    return all;
}

void count(const recording_t& recording, const Input& input, int index, const Candidate& candidate) {
    candidate.estimate(input);  // what is done once only is not counted
    CALLGRIND_START_INSTRUMENTATION;
    CALLGRIND_ZERO_STATS;
    candidate.estimate(input);
    CALLGRIND_DUMP_STATS;
    CALLGRIND_STOP_INSTRUMENTATION;
    std::printf("%s,%d,\"%s\"\n", recording.name, index, candidate.name.c_str());
}

}  // namespace
}  // namespace evaluation

int main(int argc, char** argv) {
    if (argc < 3) return std::fputs("usage: roadpose-count RECORDING FRAME...\n", stderr), 2;
    cv::setNumThreads(1);
    try {
        const benchmark::OpenRecording open(argv[1]);
        const std::vector<evaluation::Candidate> candidates = evaluation::counted_candidates(open.recording);
        for (int i = 2; i < argc; ++i) {
            const int index = std::stoi(argv[i]);
            const evaluation::Input input = evaluation::load_input(open.recording, index);
            for (const evaluation::Candidate& candidate : candidates)
                evaluation::count(open.recording, input, index, candidate);
            std::fprintf(stderr, "\r  %s: %d of %d ", open.recording.name, i - 1, argc - 2);
        }
        std::fputc('\n', stderr);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "roadpose-count: %s\n", error.what());
        return 3;
    }
    return 0;
}
