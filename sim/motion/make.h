// Factory of trajectories.
#pragma once

#include <cstdint>
#include <memory>

#include "sim/motion/description.h"
#include "sim/motion/trajectory.h"

namespace sim {

// A trajectory for stamps from 0 to last_stamp_s, each with `margin_s` around it. Within the margin of the first and
// last stamp a scripted or recorded motion may be extrapolated at constant velocity; a sampled one before the first
// only, so that a longer scenario begins with the same frames. Throws std::invalid_argument and settings::Error, as the
// constructors of the trajectories do.
std::unique_ptr<Trajectory> MakeTrajectory(const MotionDescription& motion, std::uint64_t seed, double last_stamp_s,
                                           double margin_s);

}  // namespace sim
