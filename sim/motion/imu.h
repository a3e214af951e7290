// Inertial measurement unit (IMU) that is fixed to the camera: specific force and angular rate, white noise,
// random-walk biases.
// Source: f = R_IW (a_I - g); noise and bias as in Trawny and Roumeliotis 2005, "Indirect Kalman filter for 3D attitude
//   estimation", and Kalibr's IMU noise model.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/motion/trajectory.h"

namespace sim {

enum class ImuReading {
  instant,  // the value at the stamp
  mean      // what an integrating unit gives, over the reading's period with the stamp in its middle: see ImuAt
};

struct ImuParams {
  double rate_hz = 200.0;
  Pose T_CI;                                 // maps points from I to C; I = C unless told
  glm::dvec3 gravity_W{0.0, -9.81, 0.0};     // [m/s^2]
  ImuReading reading = ImuReading::instant;  // mean: for a motion whose acceleration jumps, such as a sampled one
  double gyroscope_noise = 0.0;      // square root of the power spectral density of white noise [rad/s/sqrt(Hz)]
  double accelerometer_noise = 0.0;  // the same [m/s^2/sqrt(Hz)]
  double gyroscope_walk = 0.0;       // of the noise that drives the bias [rad/s^2/sqrt(Hz)]
  double accelerometer_walk = 0.0;   // the same [m/s^3/sqrt(Hz)]
};

// Everything wrong with the parameters, one sentence each; empty when all is well.
std::vector<std::string> Problems(const ImuParams& params);

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
// reading. So what is read at a stamp does not depend on the range.
std::vector<ImuSample> ImuReadings(const Trajectory& trajectory, const ImuParams& params, std::uint64_t seed,
                                   std::int64_t first_ns, std::int64_t last_ns);

}  // namespace sim
