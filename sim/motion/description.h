// Purpose: what a scenario says about the motion, before any file is read.
#pragma once

#include <filesystem>
#include <glm/vec3.hpp>
#include <optional>
#include <variant>
#include <vector>

#include "sim/motion/pose.h"

namespace sim {

// Sampled from the nearly-constant-velocity model: sim/motion/sampled.h.
struct SampledMotion {
  Pose start;                        // at t = 0
  glm::dvec3 velocity{0.0};          // v_WC at t = 0 [m/s]
  glm::dvec3 angular_rate{0.0};      // w_WC_C at t = 0 [rad/s]
  double velocity_sigma = 0.0;       // above 0: v_WC at t = 0 is drawn about `velocity`, per axis of W [m/s]
  double angular_rate_sigma = 0.0;   // above 0: the same for w_WC_C, per axis of C [rad/s]
  double position_noise = 0.5;       // square root of the power spectral density of acceleration [m/s^1.5]
  double orientation_noise = 0.5;    // the same for angular acceleration [rad/s^1.5]
  double position_return = 0.0;      // [1/s] 0: none. Larger: pulled back to the start harder and sooner
  double orientation_return = 0.0;   // [1/s] the same for orientation
  double knot_step_s = 1.0 / 240.0;  // frames at 10, 12, 15, 20, 24, 30, 40, 48, 60, 80, 120, 240 Hz fall on knots
};

struct KeyPose {
  double t_s = 0.0;
  Pose pose;
};

// A spline through key poses: sim/motion/spline.h.
struct ScriptedMotion {
  std::vector<KeyPose> keys;  // at least two, times increasing, the first at 0
};

// A recorded trajectory: sim/motion/recorded.h.
struct RecordedMotion {
  std::filesystem::path file;  // TUM: timestamp tx ty tz qx qy qz qw
  double start_s = 0.0;        // of t = 0 after the file's first stamp
  double average_s = 0.030;    // poses within such a time count as one, their mean; 0: each counts
  std::optional<Pose> place;   // the whole motion is moved rigidly so that it starts here; without: as recorded
};

using MotionDescription = std::variant<SampledMotion, ScriptedMotion, RecordedMotion>;

}  // namespace sim
