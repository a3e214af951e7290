// Parameters of a motion. No file has been read yet.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <numbers>
#include <optional>
#include <variant>
#include <vector>

#include "sim/motion/pose.h"
#include "tools/base/settings/fields.h"

namespace sim {

using settings::Range;
using settings::Unit;

// A box in W that a sampled motion is kept in: sim/motion/sampled.h.
struct SoftWalls {
  glm::dvec3 low{0.0}, high{0.0};  // [m]
  double margin = 0.5;             // [m]
  double rate = 4.0;               // [1/s]
};

// Sampled from the nearly-constant-velocity model: sim/motion/sampled.h.
struct SampledMotion {
  Pose start;                                              // at t = 0
  glm::dvec3 velocity{0.0};                                // v_WC at t = 0 [m/s]
  glm::dvec3 angular_rate{0.0};                            // w_WC_C at t = 0 [rad/s]
  double velocity_sigma = 0.0, angular_rate_sigma = 0.0;   // [m/s], [rad/s]
  double position_noise = 0.5, orientation_noise = 0.5;    // [m/s^1.5], [rad/s^1.5]
  double position_return = 0.0, orientation_return = 0.0;  // [1/s]
  std::optional<SoftWalls> walls;
  double knot_step_s = 1.0 / 240.0;  // frames at 10, 12, 15, 20, 24, 30, 40, 48, 60, 80, 120, 240 Hz fall on knots
};

// But for the start pose.
template <class V>
void Visit(V& v, SampledMotion& p) {
  const Range place{-1e6, 1e6}, noise = Range::AtLeast(0);
  v.Child("start", [&](auto& start) {
    start("velocity", p.velocity, {Unit::speed, place, "v_WC at t = 0"});
    start("angular_rate", p.angular_rate, {Unit::angular_rate, place, "w_WC_C at t = 0"});
    start("velocity_sigma", p.velocity_sigma, {Unit::speed, noise, "above 0: drawn about it, per axis of W and seed"});
    start("angular_rate_sigma", p.angular_rate_sigma, {Unit::angular_rate, noise, "the same, per axis of C"});
  });
  v.Required("position_noise", p.position_noise,
             {Unit::acceleration_density, noise, "root of the power spectral density of white acceleration"});
  v.Required("orientation_noise", p.orientation_noise,
             {Unit::angular_acceleration_density, noise, "the same of white angular acceleration"});
  v("knot_step", p.knot_step_s, {Unit::time, Range{1e-5, 0.1}, "the model's own step"});
  v("position_return", p.position_return, {Unit::rate, noise, "r: sigma / (2 r^1.5) from the start in the long run"});
  v("orientation_return", p.orientation_return, {Unit::rate, noise, "the same of the orientation"});
  if (!p.walls) return;
  v.Child("walls", [&](auto& walls) {
    walls.Required("low", p.walls->low, {Unit::length, place, "corner of a box in W that keeps the camera in"});
    walls.Required("high", p.walls->high, {Unit::length, place, "the opposite corner"});
    walls("margin", p.walls->margin, {Unit::length, Range::Positive(), "distance from a wall where it begins to push"});
    walls("rate", p.walls->rate, {Unit::rate, Range::Positive(), "a speed v is turned round within v / (e rate)"});
  });
}
// Ranges, and rules between several values. Keys are those of a trajectory.
std::vector<settings::FieldProblem> Problems(SampledMotion motion);

enum class Carrier { handheld, drone, vehicle };

// Random motion, of hands and drones fitted to recordings: sim/motion/carrier_motion.h.
struct CarrierMotionParams {
  Carrier model = Carrier::handheld;
  std::optional<std::uint64_t> seed;       // none: the scenario's
  std::optional<double> speed, turn_rate;  // mean [m/s], [rad/s]; none: the recordings' medians, a shaken path's own
  double vehemence = 1, tremor = 1;
};
template <class V>
void Visit(V& v, CarrierMotionParams& p) {
  v("seed", p.seed, {Range{0, 1e15}, "handheld, drone, vehicle, shake: of the path; none: the scenario's"});
  v("speed", p.speed,
    {Unit::speed, Range{0, 100}, "mean; none: recordings' median, a shaken path's own, vehicle 3 m/s"});
  if (p.model == Carrier::vehicle) return;
  v("turn_rate", p.turn_rate, {Unit::angular_rate, Range{0, 20}, "the same of turns"});
  v("vehemence", p.vehemence, {Range{0, 10}, "of accelerations from 0.2 Hz on; 1: the recordings' mean at this speed"});
  v("tremor", p.tremor, {Range{0, 10}, "of those that do not depend on speed, mostly above 2 Hz; 1: the mean"});
}

// A camera carried through a world: sim/motion/roaming.h.
struct RoamingMotion {
  CarrierMotionParams carrier;
  std::optional<Pose> start;                    // none: a free place is found
  double clearance = 0.25, turning_radius = 5;  // [m]
  std::optional<glm::dvec3> look_at;
};
// But for the start.
template <class V>
void Visit(V& v, RoamingMotion& p) {
  Visit(v, p.carrier);
  v("clearance", p.clearance, {Unit::length, Range{0, 1e3}, "handheld, drone, vehicle, placing: auto: from surfaces"});
  if (p.carrier.model == Carrier::vehicle)
    return v("turning_radius", p.turning_radius, {Unit::length, Range::Positive(), "vehicle: the smallest"});
  v("look_at", p.look_at, {Unit::length, Range{-1e6, 1e6}, "handheld, drone: instead of where there is most to see"});
}

struct KeyPose {
  double t_s = 0.0;
  Pose pose;
};

// A spline through key poses: sim/motion/spline.h.
struct ScriptedMotion {
  std::vector<KeyPose> keys;  // at least two, times increasing, the first at 0
  std::optional<CarrierMotionParams> shake;
};

// A recorded trajectory: sim/motion/recorded.h.
struct RecordedMotion {
  std::filesystem::path file;  // TUM: timestamp tx ty tz qx qy qz qw
  std::string place{};         // FILE:LINE:COLUMN in the scenario; empty: none
  double start_time_s = 0.0;
  double averaging_time_s = 0.030;
  enum class Placing { as_recorded, automatic } placing = Placing::as_recorded;
  double clearance = 0.25;         // of a path that is placed automatically [m]
  std::optional<Pose> start_pose;  // the whole motion is moved rigidly so that it starts here; without: as recorded
};

// But for file, place and start pose.
template <class V>
void Visit(V& v, RecordedMotion& p) {
  v.Renamed("start", "start_time");
  v.Renamed("average", "averaging_time");
  v.Renamed("place", "start_pose");
  v("start_time", p.start_time_s, {Unit::time, Range::AtLeast(0), "recorded: t = 0 after the file's first stamp"});
  v("averaging_time", p.averaging_time_s, {Unit::time, Range{0, 0.5}, "recorded: poses within it count as their mean"});
  using Placing = RecordedMotion::Placing;
  v("placing", p.placing, {{"as_recorded", Placing::as_recorded}, {"auto", Placing::automatic}},
    "recorded: where it lies; auto: where it passes through nothing and there is most to see");
  v("clearance", p.clearance, {Unit::length, Range{0, 1e3}, "handheld, drone, vehicle, placing: auto: from surfaces"});
}

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
  std::optional<CarrierMotionParams> shake;
};

enum class PathKind { orbit, half_sphere, rpy, dolly };

// But for the start pose and the speed.
template <class V>
void Visit(V& v, PathKind kind, PathMotion& p) {
  constexpr double kTurn = 2 * std::numbers::pi;
  const Range place{-1e6, 1e6}, period{1e-3, 1e6};
  if (kind == PathKind::orbit || kind == PathKind::half_sphere) {
    v.Required("center", p.pivot, {Unit::length, place, "orbit, half_sphere: the camera turns about it"});
    v.Required("period", p.azimuth.period_s, {Unit::time, period, "of a turn or a swing; dolly: there and back"});
  }
  if (kind == PathKind::orbit) {
    v("sweep", p.azimuth.size, {Unit::angle, Range{0, kTurn}, "swings by half of it to both sides; orbit: 0 is round"});
    p.azimuth.kind = p.azimuth.size > 0 ? Swing::Kind::about : Swing::Kind::steady;
    p.azimuth.size = p.azimuth.size > 0 ? p.azimuth.size / 2 : kTurn;
  } else if (kind == PathKind::half_sphere) {
    v.Required("sweep", p.azimuth.size, {Unit::angle, Range{0, kTurn}, "swings by half of it to both sides"});
    v.Required("rise", p.elevation.size, {Unit::angle, Range{0, kTurn / 4}, "half_sphere: climbs, and comes back"});
    v.Required("rise_period", p.elevation.period_s, {Unit::time, period, "half_sphere: period of the climb"});
    p.azimuth.size /= 2;
    p.elevation.kind = Swing::Kind::there_and_back;
  } else if (kind == PathKind::rpy) {
    glm::dvec3 angles(0.0), periods(1.0);
    v.Required("angles", angles, {Unit::angle, Range{-kTurn, kTurn}, "rpy: of roll, pitch, yaw, on the spot"});
    v.Required("periods", periods, {Unit::time, period, "each is angle * sin(2 pi t / period)"});
    p.roll = {Swing::Kind::about, angles.x, periods.x};
    p.pitch = {Swing::Kind::about, angles.y, periods.y};
    p.yaw = {Swing::Kind::about, angles.z, periods.z};
  } else {
    v.Required("move", p.move, {Unit::length, place, "dolly: there and back, in W"});
    v.Required("period", p.along.period_s, {Unit::time, period, "of it"});
    p.along = {Swing::Kind::there_and_back, 1, p.along.period_s};
  }
}

using MotionDescription = std::variant<SampledMotion, ScriptedMotion, RecordedMotion, PathMotion, RoamingMotion>;

}  // namespace sim
