// Purpose: from what a scenario says about the motion to the motion.
#pragma once

#include <cstdint>
#include <memory>

#include "sim/motion/description.h"
#include "sim/motion/trajectory.h"

namespace sim {

// A trajectory for stamps from 0 to last_stamp_s, each with `margin_s` around it: within the margin of the first and
// last stamp a scripted or recorded motion may go on at constant velocity; a sampled one does so before the first only,
// so that what comes later changes no frame. Throws what the one that is described throws: std::invalid_argument,
// settings::Error.
std::unique_ptr<Trajectory> MakeTrajectory(const MotionDescription& motion, std::uint64_t seed, double last_stamp_s,
                                           double margin_s);

}  // namespace sim
