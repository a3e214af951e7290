// Purpose: from the simulator's types to those of the odometry and of the judge. The image goes to the one, the truth
// to the other.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/simulator.h"
#include "tools/vobench/result.h"
#include "vo/geometry/camera.h"
#include "vo/sequence/reader.h"

namespace vobench {

vo::Camera ToOdometry(const sim::CameraParams& camera);
// A copy of the pixels, in OpenCV's order of colours.
vo::Frame ToOdometry(const sim::Frame& frame);

// Adds the truth of a frame.
void Append(std::int64_t stamp_ns, const sim::Truth& of_frame, Truth& truth);
// The truth of one frame alone.
Truth TruthOf(const sim::Simulator& simulator, std::int64_t frame);

// To stderr, one line each.
void PrintWarnings(const std::vector<std::string>& warnings);

}  // namespace vobench
