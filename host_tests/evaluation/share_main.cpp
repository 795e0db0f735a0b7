// roadpose-share RECORDING >share.csv: Method 2 alone on as many points as 1 % of the free map's pixels. Our own "100 %" is
// far fewer: one pixel in 2 x 4, in the corridor's box, thinned to ROADPOSE_MAX_POINTS. One line a frame.
#include <opencv2/core.hpp>

#include <cstdio>
#include <exception>

#include "measurement.hpp"
#include "ours.hpp"
#include "virtual_map.hpp"

namespace evaluation {
namespace {

void print_frame(const recording_t& recording, int index) {
    const Input input = load_input(recording, index);
    Ours all(recording, settings_of(2, false, 100));
    all.process(input.native);
    const int pixels = cv::countNonZero(free_pixels(input.disparity, input.rig())), points = all.instance().points.count;
    const int percent = points > 0 ? std::clamp((pixels + points / 2) / points, 1, 100) : 100;
    Ours some(recording, settings_of(2, false, percent));
    const Answer answer = answer_of(some.process(input.native));
    const recording_truth_t& truth = input.frame.truth;
    std::printf("%s,%d,%d,%d,%d,%s", recording.name, index, pixels, points, percent, answer.status.c_str());
    if (answer.status != "ok") std::puts(",,,");
    else
        std::printf(",%.6f,%.6f,%.6f\n", answer.pose.pitch_deg - truth.pitch_deg, answer.pose.roll_deg - truth.roll_deg,
                    answer.pose.height_m - truth.height_m);
}

}  // namespace
}  // namespace evaluation

int main(int argc, char** argv) {
    if (argc != 2) return std::fputs("usage: roadpose-share RECORDING\n", stderr), 2;
    std::puts("recording,frame,pixels,points,percent,status,pitch,roll,height");
    try {
        const benchmark::OpenRecording open(argv[1]);
        for (int index = 0; index < open.recording.frames; ++index) evaluation::print_frame(open.recording, index);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "roadpose-share: %s\n", error.what());
        return 3;
    }
    return 0;
}
