// Parameters of a motion. No file has been read yet.
#pragma once

#include <filesystem>
#include <glm/vec3.hpp>
#include <optional>
#include <variant>
#include <vector>

#include "sim/motion/pose.h"

namespace sim {

// A box in W that a sampled motion is kept in: sim/motion/sampled.h.
struct SoftWalls {
  glm::dvec3 low{0.0}, high{0.0};  // [m]
  double margin = 0.5;             // how far before a wall it begins to push [m]
  double rate = 4.0;               // how hard [1/s]: who comes at speed v is turned round within v / (e rate)
};

// Sampled from the nearly-constant-velocity model: sim/motion/sampled.h.
struct SampledMotion {
  Pose start;                       // at t = 0
  glm::dvec3 velocity{0.0};         // v_WC at t = 0 [m/s]
  glm::dvec3 angular_rate{0.0};     // w_WC_C at t = 0 [rad/s]
  double velocity_sigma = 0.0;      // above 0: v_WC at t = 0 is drawn about `velocity`, per axis of W [m/s]
  double angular_rate_sigma = 0.0;  // above 0: the same for w_WC_C, per axis of C [rad/s]
  double position_noise = 0.5;      // square root of the power spectral density of acceleration [m/s^1.5]
  double orientation_noise = 0.5;   // the same for angular acceleration [rad/s^1.5]
  double position_return = 0.0;     // [1/s] 0: none. Larger: pulled back to the start harder and sooner
  double orientation_return = 0.0;  // [1/s] the same for orientation
  std::optional<SoftWalls> walls;
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

// A number that changes with time.
struct Swing {
  enum class Kind {
    steady,          // size * t / period
    about,           // size * sin(2 pi t / period)
    there_and_back,  // size * (1 - cos(2 pi t / period)) / 2
  };
  Kind kind = Kind::about;
  double size = 0;  // [rad], or of `move`
  double period_s = 1;
};

// A path in closed form: sim/motion/path.h.
struct PathMotion {
  Pose start;             // at t = 0
  glm::dvec3 pivot{0.0};  // of azimuth and elevation [m]
  Swing azimuth, elevation, yaw, pitch, roll;
  glm::dvec3 move{0.0};  // [m]
  Swing along;           // how much of it
};

using MotionDescription = std::variant<SampledMotion, ScriptedMotion, RecordedMotion, PathMotion>;

}  // namespace sim
