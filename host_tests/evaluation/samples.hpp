// How the peers read a frame: the raw 16-bit samples as they come, in the machine's byte order, the same that our library
// gets. What depends on the rig only is made once, before the first frame, as our own instance is.
#pragma once
#include <cstdint>
#include <vector>

#include "recording_file.h"

namespace evaluation {

// Small, so that a loop has it in registers.
struct SampleReader {
    const int* least;  // for each column, the first sample that is kept
    int offset, fraction_bits;
    double pixels, offset_px;

    // It has a disparity above 0, and lies in the crop.
    bool keeps(int u, int sample) const { return sample >= least[u]; }
    // Of a kept sample: whole pixels, and pixels.
    unsigned level(int sample) const { return static_cast<unsigned>(sample + offset) >> fraction_bits; }
    double disparity(int sample) const { return sample * pixels + offset_px; }
};

class Samples {
public:
    // cropped: only what lies within 3 m sideways and 25 m ahead in camera axes. It is what a user of a plane fit would cut
    // out before the plane is known: our default corridor, widened by half, the box that our free map uses too.
    // Throws std::runtime_error where "no match" is not a sample below all disparities, as 0 is.
    Samples(const recording_rig_t& rig, bool cropped);

    SampleReader reader() const;

private:
    recording_rig_t rig_;
    std::vector<int> least_;
    int offset_;
};

}  // namespace evaluation
