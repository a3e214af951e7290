#include "sim/scenario/motion_reader.h"

#include <stdexcept>

#include "sim/motion/spline.h"
#include "sim/scenario/path_reader.h"
#include "sim/scenario/pose_reader.h"
#include "tools/base/settings/field_reader.h"

namespace sim {
namespace {

using settings::Range;
using settings::Section;
using settings::Unit;

SampledMotion ReadSampled(Section& section) {
  SampledMotion motion;
  Section start = section.Child("start");
  ReadPose(start, motion.start);
  section.Allow("walls");
  if (section.Has("walls")) {
    motion.walls.emplace();
    Section walls = section.Child("walls");
    for (const char* key : {"low", "high"}) walls.RequirePresent(key);
  }
  if (ReadFields(section, motion)) section.Reject(Problems(motion));
  for (const char* key : {"position_noise", "orientation_noise"}) section.RequirePresent(key);
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
    const bool has_time = item.Require("time", key.t_s, Unit::time, Range::AtLeast(0));
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
  ReadFields(section, motion);
  section.Allow("start_pose");
  if (section.Has("start_pose")) {
    Section place = section.Child("start_pose");
    ReadPose(place, motion.start_pose.emplace());
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
