#include "sim/scenario/motion_reader.h"

#include <stdexcept>

#include "sim/motion/spline.h"
#include "sim/scenario/path_reader.h"
#include "sim/scenario/pose_reader.h"

namespace sim {
namespace {

using settings::Range;
using settings::Section;
using settings::Unit;

const Range kNotNegative = Range::AtLeast(0);

SampledMotion ReadSampled(Section& section) {
  SampledMotion motion;
  Section start = section.Child("start");
  ReadPose(start, motion.start);
  ReadVector(start, "velocity", motion.velocity, Unit::speed);
  ReadVector(start, "angular_rate", motion.angular_rate, Unit::angular_rate);
  start.Read("velocity_sigma", motion.velocity_sigma, Unit::speed, kNotNegative);
  start.Read("angular_rate_sigma", motion.angular_rate_sigma, Unit::angular_rate, kNotNegative);
  section.Require("position_noise", motion.position_noise, Unit::acceleration_density, kNotNegative);
  section.Require("orientation_noise", motion.orientation_noise, Unit::angular_acceleration_density, kNotNegative);
  section.Read("knot_step", motion.knot_step_s, Unit::time, Range{1e-5, 0.1});
  const Range range{0, 0.2 / motion.knot_step_s};
  section.Read("position_return", motion.position_return, Unit::rate, range);
  section.Read("orientation_return", motion.orientation_return, Unit::rate, range);
  section.Allow("walls");
  if (section.Has("walls")) {
    Section walls = section.Child("walls");
    SoftWalls& box = motion.walls.emplace();
    walls.RequirePresent("low");
    walls.RequirePresent("high");
    ReadVector(walls, "low", box.low, Unit::length);
    ReadVector(walls, "high", box.high, Unit::length);
    walls.Read("margin", box.margin, Unit::length, Range::Positive());
    walls.Read("rate", box.rate, Unit::rate, range);
    for (int axis = 0; axis < 3; ++axis) {
      if (!(box.high[axis] - box.low[axis] >= 2 * box.margin)) {
        walls.Reject("high", "'walls': between low and high there must be two margins, along each axis");
        break;
      }
    }
  }
  return motion;
}

ScriptedMotion ReadScripted(Section& section) {
  ScriptedMotion motion;
  bool good = true;
  const auto reject = [&](Section& where, const std::string& key, const std::string& message) {
    where.Reject(key, message);
    good = false;
  };
  for (Section& item : section.List("keys")) {
    KeyPose key;
    const bool has_time = item.Require("time", key.t_s, Unit::time, kNotNegative);
    if (has_time && motion.keys.empty() && key.t_s != 0)
      reject(item, "time", "'time': the first key pose must be at 0 s");
    if (has_time && !motion.keys.empty() && key.t_s <= motion.keys.back().t_s) {
      reject(item, "time",
             "'time': the times of key poses must increase, but " + settings::FormatNumber(key.t_s) +
                 " s comes after " + settings::FormatNumber(motion.keys.back().t_s) + " s");
    }
    good = ReadPose(item, key.pose) && has_time && good;
    motion.keys.push_back(key);
  }
  if (motion.keys.size() < 2) reject(section, "keys", "'trajectory.keys': two key poses are needed at least");
  if (!good) return motion;
  try {
    static_cast<void>(SplineTrajectory{motion.keys});  // for what it throws
    const double pace = ReadPace(section, motion);
    for (KeyPose& key : motion.keys) key.t_s /= pace;
  } catch (const std::invalid_argument& error) {
    section.Reject("keys", std::string("'trajectory.keys': ") + error.what());
  }
  return motion;
}

RecordedMotion ReadRecorded(Section& section, const std::filesystem::path& folder) {
  RecordedMotion motion;
  motion.file = ReadFile(section, "file", folder);
  section.Read("start", motion.start_s, Unit::time, kNotNegative);
  section.Read("average", motion.average_s, Unit::time, Range{0, 0.5});
  section.Allow("place");
  if (section.Has("place")) {
    Section place = section.Child("place");
    ReadPose(place, motion.place.emplace());
  }
  return motion;
}

}  // namespace

std::filesystem::path ReadFile(Section& section, const std::string& key, const std::filesystem::path& folder) {
  std::string name;
  return section.Require(key, name) ? folder / name : std::filesystem::path();
}

MotionDescription ReadMotion(Section& section, const std::filesystem::path& folder) {
  enum class Kind { sampled, scripted, recorded, orbit, half_sphere, rpy, dolly } kind = Kind::sampled;
  const bool known = section.RequireChoice("type", kind,
                                           {{"sampled", Kind::sampled},
                                            {"scripted", Kind::scripted},
                                            {"recorded", Kind::recorded},
                                            {"orbit", Kind::orbit},
                                            {"half_sphere", Kind::half_sphere},
                                            {"rpy", Kind::rpy},
                                            {"dolly", Kind::dolly}});
  if (!known) {
    section.IgnoreRest();
    return SampledMotion{};
  }
  if (kind == Kind::sampled) return ReadSampled(section);
  if (kind == Kind::scripted) return ReadScripted(section);
  if (kind == Kind::recorded) return ReadRecorded(section, folder);
  return ReadPath(section, kind == Kind::orbit         ? PathKind::orbit
                           : kind == Kind::half_sphere ? PathKind::half_sphere
                           : kind == Kind::rpy         ? PathKind::rpy
                                                       : PathKind::dolly);
}

}  // namespace sim
