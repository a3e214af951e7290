// Cubic spline trajectory through key poses.
#pragma once

#include <array>
#include <vector>

#include "sim/motion/description.h"
#include "sim/motion/trajectory.h"

namespace sim {

//   q = s / |s|    w = 2 vec(conj(s) ds/dt) / |s|^2    alpha = (2 vec(conj(s) d2s/dt2) - 2 (s . ds/dt) w) / |s|^2
//
// with natural cubic splines for the seven components of (p, s). Both are C2 and pass through every key. The sign of
// each key's quaternion is that nearest to the previous one. The motion does not depend on the choice of W.
// The angular velocity varies between keys: by a factor of 1.07 from the ends to the middle at 60 degrees per key.
class SplineTrajectory : public Trajectory {
 public:
  // At least two keys, times increasing, quaternions not zero. Throws std::invalid_argument naming each pair of keys
  // between which the camera turns by more than 120 degrees.
  explicit SplineTrajectory(const std::vector<KeyPose>& keys);

  Motion At(double t_s) const override;
  double end_s() const { return times_.back(); }

 private:
  using Numbers = std::array<double, 7>;  // p, then x y z w of the quaternion

  std::vector<double> times_;
  std::vector<Numbers> values_, second_derivatives_;
};

}  // namespace sim
