// C++ includes every header and links the C library.
#include <cstdio>
#include <memory>

#include "roadpose/camera_port.h"
#include "roadpose/can.h"
#include "roadpose/heading.h"
#include "roadpose/roadpose.h"
#include "roadpose/store_port.h"
#include "roadpose/tracker.h"

int main() {
    const roadpose_rig_t rig = {640, 480, 500000, 319500, 239500, 300000};
    const auto estimator = std::make_unique<roadpose_t>();
    roadpose_disparity_format_t format;
    if (!roadpose_format_preset(&format, ROADPOSE_FORMAT_OPENCV) ||
        roadpose_init(estimator.get(), &rig, &format, nullptr) != ROADPOSE_OK) {
        return 1;
    }
    std::printf("state: %zu bytes\n", roadpose_state_bytes());
    return roadpose_state_bytes() == sizeof(roadpose_t) ? 0 : 1;
}
