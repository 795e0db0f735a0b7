#include "input.hpp"

namespace evaluation {

Input load_input(const recording_t& recording, int index) {
    Input input{benchmark::load_frame(recording, index), {}, cv::Mat1f(recording.rig.height, recording.rig.width)};
    const std::vector<std::uint8_t>& samples = input.frame.samples;
    input.native.resize(samples.size() / 2);
    for (std::size_t i = 0; i < input.native.size(); ++i)
        input.native[i] = static_cast<std::uint16_t>(samples[2 * i] << 8 | samples[2 * i + 1]);
    for (int v = 0; v < input.disparity.rows; ++v)
        for (int u = 0; u < input.disparity.cols; ++u)
            input.disparity(v, u) = static_cast<float>(input.frame.disparity(u, v));
    return input;
}

}  // namespace evaluation
