// Baseline trajectories without images: constant pose and constant velocity.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "tools/judge/evaluation/trajectory.h"

namespace evaluation {

// The true start pose, for ever, at each stamp.
Trajectory ConstantPose(const std::vector<std::int64_t>& stamps_ns, const StampedPose& start);

// The true start pose moved on with constant v (in W) and constant w (in C).
Trajectory ConstantVelocity(const std::vector<std::int64_t>& stamps_ns, const StampedPose& start,
                            const StampedVelocity& velocity);

// The velocity at the start of a trajectory: mean over its first 0.1 s (to the first pose at least so much later; to
// the last if none is). Zero for a single pose.
StampedVelocity StartVelocity(const Trajectory& trajectory);

}  // namespace evaluation
