// Sample of the nearly-constant-velocity model.
// Source: Bar-Shalom, Li and Kirubarajan 2001, "Estimation with applications to tracking and navigation", section
//   6.2.2; docs/conventions.md.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/motion/description.h"
#include "sim/motion/trajectory.h"

namespace sim {

// Knots lie h = knot_step_s apart. From knot to knot, per axis, with correlated noise (n1, n2) of covariance
// Q = sigma^2 [h^3/3 h^2/2; h^2/2 h], drawn by Q's Cholesky factor from numbers keyed by (seed, knot, axis):
//
//   p' = p + h v + h^2/2 a + n1     v' = v + h a + n2       a = -r^2 (p - p_start) - 2 r v
//   q' = q * Exp(h w + h^2/2 b + n1)   w' = w + h b + n2    b = -r^2 Log(q_start^-1 q) - 2 r w     (r: *_return)
//
// The first knot has the velocities given, each axis plus its sigma times a normal number keyed by (seed, axis).
//
// Without return (r = 0) positions and velocities at knots are an exact sample of the model, also over several knots;
// orientation is so from knot to knot, in the tangent space at the earlier one, the velocity being the true angular
// velocity. A filter with a longer step neglects that rotations do not commute: its increments have an additional error
// of 0.8 per cent of their noise's standard deviation at 0.5 rad/s^1.5 over 10 s, growing with the turn rate
// (sampled_test measures it). With knot_step = the time between frames the frames follow the filter's model exactly.
//
// With return there is an additional pull towards the start, critically damped, held over one step; in the long run the
// standard deviations are sigma / (2 r^1.5) of a position and sigma / (2 r^0.5) of a velocity per axis, and for small
// angles of the orientation.
//
// Soft walls change the model within their margin only: beyond its inner edge by s, -rate^2 s is added to an axis's
// acceleration, and -2 rate v while it moves outwards. A camera that arrives at speed v penetrates by v / (e rate); a
// wall is soft, and large noise pushes through.
//
// Between knots the path is the cubic Hermite interpolant, which for the position is its expectation given the knots.
// Its variance is smaller than the model's there by at most sigma^2 h^3/192 (position) and sigma^2 h/16 (velocity).
// Velocities and accelerations are the exact derivatives of this path everywhere; accelerations jump at knots, by some
// 3 sigma / sqrt(h), as the model's own has no limit there. Frames whose rate divides 1/h lie on knots.
class SampledTrajectory : public Trajectory {
 public:
  // Throws std::invalid_argument for sigmas, noises or returns that are negative, a step outside (0, 0.1] s, return *
  // step > 0.2, a start that is not finite, or more than 2^25 knots.
  SampledTrajectory(const SampledMotion& motion, std::uint64_t seed, double end_s);

  Motion At(double t_s) const override;

  const std::vector<Motion>& knots() const { return knots_; }

 private:
  double step_s_;
  std::vector<Motion> knots_;
};

}  // namespace sim
