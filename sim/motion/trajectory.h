// Trajectory: pose, velocity and acceleration as functions of time, in closed form; ground truth of a frame.
#pragma once

#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <memory>

#include "sim/motion/description.h"
#include "sim/motion/pose.h"

namespace sim {

class Surroundings;

struct Motion {
  Pose pose;
  glm::dvec3 v_WC{0.0};        // of the camera centre, in W [m/s]: the exact derivative of pose.p_WC
  glm::dvec3 w_WC_C{0.0};      // of C against W, in C [rad/s]: q(t + dt) = q(t) * Exp(w dt) to first order
  glm::dvec3 a_WC{0.0};        // in W [m/s^2]: the exact derivative of v_WC
  glm::dvec3 alpha_WC_C{0.0};  // in C [rad/s^2]: the exact derivative of w_WC_C by components
};

// Time is in seconds; 0 is the stamp of the first frame. It is extrapolated at constant velocity before 0 and after the
// end, by half an exposure at least. Where an acceleration jumps (a sampled motion at its knots), it is the
// right-hand limit.
class Trajectory {
 public:
  virtual ~Trajectory() = default;
  virtual Motion At(double t_s) const = 0;
};

// A trajectory for stamps from 0 to last_stamp_s, each with `margin_s` around it. Within the margin of the first and
// last stamp a scripted or recorded motion may be extrapolated at constant velocity; a sampled one before the first
// only, so that a longer scenario begins with the same frames. `around`: surfaces for motions that keep a clearance
// (sim/motion/roaming.h) or are placed in a world; null: there are none. Throws std::invalid_argument and
// settings::Error, as the constructors of the trajectories do.
std::unique_ptr<Trajectory> MakeTrajectory(const MotionDescription& motion, std::uint64_t seed, double last_stamp_s,
                                           double margin_s, const Surroundings* around = nullptr);
// Whether MakeTrajectory needs `around`.
bool NeedsSurroundings(const MotionDescription& motion);

// Of a frame C that is fixed to a moving body, such as a camera of a rig: X_B = R(q) X_C + p.
std::shared_ptr<const Trajectory> Mounted(std::shared_ptr<const Trajectory> body, const Pose& T_BC);

// At the stamp; conventions as in docs/conventions.md.
struct Truth {
  glm::dvec3 p_WC{0.0};                 // [m]
  glm::dquat q_WC{1.0, 0.0, 0.0, 0.0};  // unit, w >= 0
  glm::dvec3 v_WC{0.0};                 // in W [m/s]
  glm::dvec3 w_WC_C{0.0};               // in C [rad/s]
  glm::dvec3 a_WC{0.0};                 // in W [m/s^2]; the exact derivative of v_WC
  glm::dvec3 alpha_WC_C{0.0};           // in C [rad/s^2]
};

// Throws std::logic_error when the motion is not finite or not a rotation (a programming error).
Truth TruthAt(const Trajectory& trajectory, double t_s);

}  // namespace sim
