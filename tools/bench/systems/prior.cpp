#include "tools/bench/systems/prior.h"

#include "vo/base/random.h"

namespace vobench {
namespace {

// Standard normal as a function of (seed, dimension). The second word of the counter separates it from the draws of
// simulator and filter with the same seed.
double Normal(std::uint64_t seed, std::uint32_t dimension) {
  return vo::Normal({seed, vo::Stream{}, dimension, 0x7072696f}, 0);  // "prio"
}

}  // namespace

vo::Prior PriorAtOrigin(const PriorSettings& settings) {
  const auto square = [](double sigma) { return sigma * sigma; };
  vo::Prior prior;
  prior.pose_covariance = vo::Matrix6::Identity() * square(kStartSigma);
  prior.velocity_covariance.setZero();
  prior.velocity_covariance.diagonal().head<3>().setConstant(square(settings.velocity_sigma));
  prior.velocity_covariance.diagonal().tail<3>().setConstant(square(settings.angular_rate_sigma));
  return prior;
}

vo::Prior PriorFromTruth(const PriorSettings& settings, const evaluation::StampedPose& pose,
                         const evaluation::StampedVelocity& velocity, std::uint64_t seed) {
  vo::Prior prior = PriorAtOrigin(settings);
  prior.pose = {pose.p_WC, pose.q_WC};
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    prior.v_WC[axis] = velocity.v_WC[axis] + settings.velocity_sigma * Normal(seed, axis);
    prior.w_WC_C[axis] = velocity.w_WC_C[axis] + settings.angular_rate_sigma * Normal(seed, 3 + axis);
  }
  return prior;
}

vo::Prior PriorOf(const PriorSettings& settings, const sim::MotionDescription& motion, const Truth& start,
                  std::uint64_t seed) {
  if (settings.start == PriorSettings::Start::origin) return PriorAtOrigin(settings);
  vo::Prior prior = PriorFromTruth(settings, start.poses.front(), start.velocities->front(), seed);
  if (const auto* sampled = std::get_if<sim::SampledMotion>(&motion)) {
    const glm::dvec3 &v = sampled->velocity, &w = sampled->angular_rate;
    if (sampled->velocity_sigma > 0) prior.v_WC = {v.x, v.y, v.z};
    if (sampled->angular_rate_sigma > 0) prior.w_WC_C = {w.x, w.y, w.z};
  }
  return prior;
}

evaluation::JudgeOptions JudgeOptionsOf(const PriorSettings& prior) {
  evaluation::JudgeOptions how;
  if (prior.start == PriorSettings::Start::origin) how.gauge = evaluation::Gauge::first_pose;
  return how;
}

evaluation::Matrix12d StartCovariance(const vo::Prior& prior) {
  evaluation::Matrix12d start = evaluation::Matrix12d::Zero();
  start.topLeftCorner<6, 6>() = prior.pose_covariance;
  start.bottomRightCorner<6, 6>() = prior.velocity_covariance;
  return start;
}

vo::Prior PriorOf(const PriorSettings& settings, const sim::PointWorld& world, std::uint64_t seed) {
  Truth start;
  Append(world.StampNs(0), world.TruthAt(0), start);
  return PriorOf(settings, world.scenario().motion, start, seed);
}

}  // namespace vobench
