#include "sim/motion/imu.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "sim/motion/so3.h"
#include "sim/random/random.h"

namespace sim {
namespace {

// Of I's origin, in W: v_C + w x r turned to W.
glm::dvec3 VelocityOfI(const Motion& m, const glm::dvec3& p_CI) {
  return m.v_WC + m.pose.q_WC * glm::cross(m.w_WC_C, p_CI);
}

glm::dvec3 AccelerationOfI(const Motion& m, const glm::dvec3& p_CI) {
  const glm::dvec3 turning = glm::cross(m.w_WC_C, glm::cross(m.w_WC_C, p_CI));
  return m.a_WC + m.pose.q_WC * (glm::cross(m.alpha_WC_C, p_CI) + turning);
}

// Two vectors of standard normal numbers: the gyroscope's and the accelerometer's.
std::array<glm::dvec3, 2> Draw(std::uint64_t seed, Stream stream, std::int64_t k) {
  return NormalVectors(seed, stream, static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(k >> 32));
}

}  // namespace

ImuSample ImuAt(const Trajectory& trajectory, const ImuParams& params, double t_s) {
  const glm::dvec3& p_CI = params.T_CI.p_WC;
  const glm::dquat& q_CI = params.T_CI.q_WC;
  const Motion at = trajectory.At(t_s);
  glm::dvec3 w_C = at.w_WC_C, a_W = AccelerationOfI(at, p_CI);
  if (params.reading == ImuReading::mean) {
    const double period = 1 / params.rate_hz;
    const Motion before = trajectory.At(t_s - period / 2), after = trajectory.At(t_s + period / 2);
    w_C = Log(glm::conjugate(before.pose.q_WC) * after.pose.q_WC) / period;
    a_W = (VelocityOfI(after, p_CI) - VelocityOfI(before, p_CI)) / period;
  }
  ImuSample sample;
  sample.w_I = glm::conjugate(q_CI) * w_C;
  sample.f_I = glm::conjugate(at.pose.q_WC * q_CI) * (a_W - params.gravity_W);
  return sample;
}

std::vector<ImuSample> ImuReadings(const Trajectory& trajectory, const ImuParams& params, std::uint64_t seed,
                                   std::int64_t first_ns, std::int64_t last_ns) {
  const double root = std::sqrt(params.rate_hz);
  std::vector<ImuSample> samples;
  glm::dvec3 gyroscope_bias(0.0), accelerometer_bias(0.0);
  for (std::int64_t k = 0;; ++k) {
    const std::int64_t stamp_ns = std::llround(static_cast<double>(k) * 1e9 / params.rate_hz);
    if (stamp_ns > last_ns) return samples;
    if (k > 0) {
      const auto [gyroscope, accelerometer] = Draw(seed, Stream::imu_walk, k);
      gyroscope_bias += params.gyroscope_walk / root * gyroscope;
      accelerometer_bias += params.accelerometer_walk / root * accelerometer;
    }
    if (stamp_ns < first_ns) continue;
    ImuSample sample = ImuAt(trajectory, params, static_cast<double>(stamp_ns) * 1e-9);
    const auto [gyroscope, accelerometer] = Draw(seed, Stream::imu_noise, k);
    sample.stamp_ns = stamp_ns;
    sample.w_I += gyroscope_bias + params.gyroscope_noise * root * gyroscope;
    sample.f_I += accelerometer_bias + params.accelerometer_noise * root * accelerometer;
    sample.gyroscope_bias = gyroscope_bias;
    sample.accelerometer_bias = accelerometer_bias;
    samples.push_back(sample);
  }
}

}  // namespace sim
