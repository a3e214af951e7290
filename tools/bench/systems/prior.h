// Purpose: what the odometry is told before the first frame. The one place where it may learn something of the truth.
#pragma once

#include <cstdint>

#include "sim/motion/description.h"
#include "sim/points/point_world.h"
#include "tools/bench/points/truth.h"
#include "tools/bench/systems/odometry_settings.h"
#include "tools/judge/evaluation/estimate_run.h"
#include "vo/odometry.h"

namespace vobench {

// Of the start pose, per axis: as good as exact, but not singular [m, rad].
inline constexpr double kStartSigma = 1e-6;

// At the origin and at rest, with the sigmas given.
vo::Prior PriorAtOrigin(const PriorSettings& settings);

// At the true pose. The velocity is the true one plus noise drawn from N(0, sigma^2) per axis, a function of the seed
// alone, and its covariance says so: an honest prior.
vo::Prior PriorFromTruth(const PriorSettings& settings, const evaluation::StampedPose& pose,
                         const evaluation::StampedVelocity& velocity, std::uint64_t seed);

// As the settings have it. A velocity that the scenario draws for each seed (velocity_sigma, angular_rate_sigma of a
// sampled motion) is not told with noise of its own: the odometry is told what it is drawn about.
vo::Prior PriorOf(const PriorSettings& settings, const sim::MotionDescription& motion, const Truth& start,
                  std::uint64_t seed);
// The same at the start of a world.
vo::Prior PriorOf(const PriorSettings& settings, const sim::PointWorld& world, std::uint64_t seed);

// Of pose and velocity together, as the bound takes it.
evaluation::Matrix12d StartCovariance(const vo::Prior& prior);

}  // namespace vobench
