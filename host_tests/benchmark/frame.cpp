#include "frame.hpp"

#include <stdexcept>

namespace benchmark {

Frame load_frame(const recording_t& recording, int index) {
    const std::size_t pixels = static_cast<std::size_t>(recording.rig.width) * recording.rig.height;
    Frame frame{&recording.rig, std::vector<std::uint8_t>(2 * pixels), std::vector<std::uint8_t>(pixels),
                recording.truth[index]};
    if (!recording_read_disparity(&recording, index, frame.samples.data()))
        throw std::runtime_error("unreadable frame " + std::to_string(index));
    if (!recording_read_road(&recording, index, frame.road.data())) frame.road.clear();
    return frame;
}

}  // namespace benchmark
