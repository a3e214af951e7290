// Closed-form trajectories: orbit, half sphere, rotation on the spot, dolly. Unlimited in time.
#pragma once

#include "sim/motion/description.h"
#include "sim/motion/trajectory.h"

namespace sim {

// p = c + A(t) (p_0 - c) + move d(t)        q = A(t) q_0 B(t)
//
// from the pose (p_0, q_0) at t = 0. A turns about the pivot c: first by the elevation about the level axis that takes
// the camera up, then by the azimuth about +y. B turns about the camera's own axes: first by the roll about z, then by
// the pitch about x, then by the yaw about y. Rates and accelerations are the exact derivatives.
class PathTrajectory : public Trajectory {
 public:
  // Throws std::invalid_argument for a period that is not positive, numbers that are not finite, and an elevation about
  // a pivot straight above or below the camera.
  explicit PathTrajectory(const PathMotion& motion);

  Motion At(double t_s) const override;

 private:
  PathMotion motion_;
  glm::dvec3 arm_, level_;  // p_0 - c; the axis of the elevation
};

// The mean of |v| over the longest period, or over [0, end_s] of another trajectory [m/s]: 4096 midpoints.
double MeanSpeed(const Trajectory& trajectory, double end_s);

}  // namespace sim
