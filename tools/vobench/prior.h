// Purpose: what the odometry is told before the first frame. The one place where it may learn something of the truth.
#pragma once

#include <cstdint>

#include "tools/vobench/odometry_settings.h"
#include "tools/vobench/result.h"
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

}  // namespace vobench
