// Purpose: a smooth path through key poses.
#pragma once

#include <array>
#include <vector>

#include "sim/motion/description.h"
#include "sim/motion/trajectory.h"

namespace sim {

// The seven numbers (p, q) go through the keys on natural cubic splines, the quaternion is normalised afterwards: q = s
// / |s|. Both are C2, pass through every key, and have their derivatives in closed form (w = 2 vec(conj(s) ds/dt) /
// |s|^2, alpha = (2 vec(conj(s) d2s/dt2) - 2 (s . ds/dt) w) / |s|^2). The quaternion's sign is chosen to be near the previous key's. Motion does not depend on the choice of W.
// Between keys that turn by much the angular velocity is not even: 1.07 times as fast in the middle as at the ends when
// two keys are 60 degrees apart.
class SplineTrajectory : public Trajectory {
 public:
  // At least two keys, times increasing, quaternions not zero. Throws std::invalid_argument naming each pair of keys
  // between which the camera turns by more than 120 degrees.
  explicit SplineTrajectory(const std::vector<KeyPose>& keys);

  Motion At(double t_s) const override;
  double end_s() const override { return times_.back(); }

 private:
  using Numbers = std::array<double, 7>;  // p, then x y z w of the quaternion

  std::vector<double> times_;
  std::vector<Numbers> values_, second_derivatives_;
};

}  // namespace sim
