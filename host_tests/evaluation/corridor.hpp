// What a user of a plain plane fit would cut out before the plane is known: the box that our free map uses too.
#pragma once
#include "recording_file.h"

namespace evaluation {

// Within 3 m sideways and 25 m ahead in camera axes: our default corridor, widened by half as our free map is.
bool is_in_crop(const recording_rig_t& rig, double x, double disparity);

}  // namespace evaluation
