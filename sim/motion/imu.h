// Inertial measurement unit (IMU) fixed to the camera: specific force and angular rate, white noise, random-walk
// biases.
// Source: f = R_IW (a_I - g); noise and bias as in Trawny and Roumeliotis 2005, "Indirect Kalman filter for 3D attitude
//   estimation", and Kalibr's IMU noise model.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/motion/trajectory.h"
#include "tools/base/settings/fields.h"

namespace sim {

enum class ImuReading {
  instant,  // the value at the stamp
  mean      // mean over the reading's period centred on the stamp, as of an integrating unit: see ImuAt
};

struct ImuParams {
  double rate_hz = 200.0;
  Pose T_CI;                              // maps points from I to C
  glm::dvec3 gravity_W{0.0, -9.81, 0.0};  // [m/s^2]
  ImuReading reading = ImuReading::instant;
  double gyroscope_noise = 0.0, accelerometer_noise = 0.0;  // [rad/s/sqrt(Hz)], [m/s^2/sqrt(Hz)]
  double gyroscope_walk = 0.0, accelerometer_walk = 0.0;    // [rad/s^2/sqrt(Hz)], [m/s^3/sqrt(Hz)]
};

template <class V>
void Visit(V& v, ImuParams& p) {
  using settings::Range, settings::Unit;
  const Range noise = Range::AtLeast(0);
  v("rate", p.rate_hz, {Unit::frequency, Range{1, 1e5}, "readings per second"});
  v("position", p.T_CI.p_WC, {Unit::length, Range{-1e6, 1e6}, "of I in C"});
  v("gravity", p.gravity_W, {Range{-1e6, 1e6}, "in W [m/s^2]"});
  v("reading", p.reading, {{"instant", ImuReading::instant}, {"mean", ImuReading::mean}},
    "at the stamp; or mean over the period, for paths whose acceleration jumps");
  v("gyroscope_noise", p.gyroscope_noise, {noise, "root of the power spectral density [rad/s/sqrt(Hz)]"});
  v("accelerometer_noise", p.accelerometer_noise, {noise, "the same [m/s^2/sqrt(Hz)]"});
  v("gyroscope_walk", p.gyroscope_walk, {noise, "of the noise that drives the bias, 0 at first [rad/s^2/sqrt(Hz)]"});
  v("accelerometer_walk", p.accelerometer_walk, {noise, "the same [m/s^3/sqrt(Hz)]"});
  v("orientation", p.T_CI.q_WC, {"of I in C: x, y, z, w"});
}

struct ImuSample {
  std::int64_t stamp_ns = 0;
  glm::dvec3 w_I{0.0};  // angular rate of I against W, in I [rad/s], bias and noise included
  glm::dvec3 f_I{0.0};  // specific force, in I [m/s^2], bias and noise included
  glm::dvec3 gyroscope_bias{0.0}, accelerometer_bias{0.0};
};

// Without bias and noise. `mean` over a period T about t:
//   w = Log(q(t - T/2)^-1 q(t + T/2)) / T      f = R_IW(t) ((v_I(t + T/2) - v_I(t - T/2)) / T - g)
// so that the product of Exp(w T) is the turn exactly, and the sum of R_WI f T + g T the change of velocity, however
// rough the path; of a smooth one it is the instant's value to T^2/24 times the second derivative.
ImuSample ImuAt(const Trajectory& trajectory, const ImuParams& params, double t_s);

// The readings with first_ns <= stamp <= last_ns, at round(k / rate). Reading k has the noise density * sqrt(rate) * a
// normal number keyed by (seed, k, axis); biases are 0 at k = 0 and gain walk / sqrt(rate) * another one with every
// reading. The reading at a stamp does not depend on the range.
std::vector<ImuSample> ImuReadings(const Trajectory& trajectory, const ImuParams& params, std::uint64_t seed,
                                   std::int64_t first_ns, std::int64_t last_ns);

}  // namespace sim
