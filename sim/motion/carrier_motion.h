// Random motion of a hand-held camera or drone, fitted to recordings, relative to a course.
// Source: scenes/generate/fit_motion.py, which makes carrier_motion_table.inc; docs/motion.md.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>
#include <numbers>
#include <vector>

#include "sim/motion/description.h"

namespace sim {

constexpr double kCarrierStep_s = 0.01;
constexpr std::size_t kCarrierComponents = 13;

// Fitted parameters. Accelerations are root mean squares of components, all three axes together.
struct CarrierMotionTable {
  double speed, turn_rate;  // medians of the recordings' means [m/s], [rad/s]
  // With the motion, of 1 m/s and 1 rad/s of mean speed and turn rate at vehemence 1; tremor [m/s^2], [rad/s^2].
  std::array<double, kCarrierComponents> linear, linear_tremor, angular, angular_tremor;
  double burst, burst_s;         // standard deviation of the logarithm of the drive, and how long it lasts
  double activity, activity_hz;  // the same of calm and busy times, for course and drive, and its corner frequency
  double course_hz;              // corner of the course's rates
  double evenness;               // of the course's speed: 0 constant, large as of a normal vector
  double climb, ahead_s;         // to both sides of the start's height [m]; turns away from surfaces so long before
};
const CarrierMotionTable& TableOf(Carrier model);

// Of the position in W and of pitch, yaw (about +y) and roll; activity: of its drive, and of the course.
struct Offset {
  glm::dvec3 move{0.0}, turn{0.0};
  double activity = 1;
};

// y1' = w (x - y1), y2' = w (y1 - y2).
template <class T>
struct LowPass {
  T first{0.0}, rate{0.0};
  void Step(double w, const T& x) {
    first += w * kCarrierStep_s * (x - first);
    rate += w * kCarrierStep_s * (first - rate);
  }
  // A step with standard normal input, scaled so that `rate` has variance 1.
  void Draw(double corner_hz, const T& normal) {
    const double w = 2 * std::numbers::pi * corner_hz;
    Step(w, 2 / std::sqrt(w * kCarrierStep_s) * normal);
  }
};

// Sum over components, half an octave apart from 0.175 Hz on, of
//   x_j = two equal resonators in a row, each x'' + 2 zeta w_j x' + w_j^2 x = its input,   zeta = 0.3
//
// driven by white noise times a burst exp(s g(t) - s^2), g of first order with standard deviation 1, and an activity,
// the same with g a LowPass. The acceleration of each has the table's root mean square: `linear`^2 (speed vehemence)^2
// + `linear_tremor`^2 tremor^2, a third of it on each axis; likewise the angles. Its power spectral density is
// u^4 / ((1 - u^2)^2 + (2 zeta u)^2)^2, u = f / f_j; its rate's root mean square is the acceleration's over 2 pi f_j.
// Components below 0.3 Hz are made smaller where the rates would exceed what is stated.
class CarrierMotion {
 public:
  // from_hz: components below are left out.
  CarrierMotion(const CarrierMotionParams& params, double from_hz);

  const CarrierMotionTable& table() const { return table_; }
  double speed() const { return speed_; }                // of all that moves, mean [m/s]
  double turn_rate() const { return turn_rate_; }        // [rad/s]
  double course_speed() const { return course_speed_; }  // root mean square of the course's own speed
  double course_turn_rate() const { return course_turn_rate_; }

  // At k * kCarrierStep_s, k = 0 ... count - 1; numbers keyed by (seed, k, component).
  std::vector<Offset> Draw(std::uint64_t seed, std::size_t count) const;

 private:
  const CarrierMotionTable& table_;
  double speed_, turn_rate_, course_speed_, course_turn_rate_;
  std::array<double, kCarrierComponents> linear_{}, angular_{};  // root mean squares of acceleration
};

}  // namespace sim
