// Prior of the odometry before the first frame: the only information from the truth that it may get.
#pragma once

#include <cstdint>

#include "sim/motion/description.h"
#include "sim/points/point_world.h"
#include "tools/bench/points/truth.h"
#include "tools/bench/systems/experiment.h"
#include "tools/judge/evaluation/summary.h"
#include "vo/base/result.h"

namespace vobench {

// Of the start pose, per axis: as good as exact, but not singular [m, rad].
inline constexpr double kStartSigma = 1e-6;

// At the origin and at rest, with the sigmas given.
vo::Prior PriorAtOrigin(const PriorSettings& settings);

// At the true pose. The velocity is the true one plus noise drawn from N(0, sigma^2) per axis, a function of the seed
// alone, with that covariance: a consistent prior.
vo::Prior PriorFromTruth(const PriorSettings& settings, const evaluation::StampedPose& pose,
                         const evaluation::StampedVelocity& velocity, std::uint64_t seed);

// Prior by the settings. Where the scenario draws a velocity for each seed (velocity_sigma, angular_rate_sigma of a
// sampled motion) the mean is the mean of that distribution, without additional noise.
vo::Prior PriorOf(const PriorSettings& settings, const sim::MotionDescription& motion, const Truth& start,
                  std::uint64_t seed);
// The same at the start of a world.
vo::Prior PriorOf(const PriorSettings& settings, const sim::PointWorld& world, std::uint64_t seed);

// How errors are aligned: from the first pose where the prior starts at the origin, else in the world frame.
evaluation::JudgeOptions JudgeOptionsOf(const PriorSettings& prior);

// Of pose and velocity together, as the bound takes it.
evaluation::Matrix12d StartCovariance(const vo::Prior& prior);

}  // namespace vobench
