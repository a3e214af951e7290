#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <stdexcept>

#include "sim/motion/path.h"
#include "sim/motion/so3.h"
#include "sim/motion/spline.h"
#include "sim/scenario/readers.h"
#include "tools/base/settings/field_reader.h"

namespace sim {
namespace {

using settings::Section;

bool ReadCameraPose(Section& section, FileCameras& cameras, Pose& pose) {
  std::string name;
  if (!section.Read("camera", name)) return false;
  for (const char* key : {"position", "look_at", "roll", "orientation"}) {
    section.Allow(key);
    if (section.Has(key)) section.Reject(key, "'camera' and '" + std::string(key) + "' exclude each other");
  }
  try {
    pose = cameras.At(name).T_WC;
    return true;
  } catch (const std::runtime_error& error) {
    section.Reject("camera", "'camera': " + std::string(error.what()));
    return false;
  }
}

// `camera`, one of a mesh file; or `position`, and either `look_at` (a point in W) with an optional `roll`, or
// `orientation`. False: it is invalid.
bool ReadPose(Section& section, const MotionNames& names, Pose& pose) {
  const Range place{-1e6, 1e6};
  if (names.cameras != nullptr) section.Allow("camera");
  if (names.cameras != nullptr && section.Has("camera")) return ReadCameraPose(section, *names.cameras, pose);
  settings::FieldReader fields(section);
  fields.Required("position", pose.p_WC, {Unit::length, place, "in W"});
  for (const char* key : {"look_at", "roll", "orientation"}) section.Allow(key);
  const auto reject = [&](const std::string& key, const std::string& message) {
    section.Reject(key, message);
    return false;
  };
  bool good = true;
  if (!section.Has("look_at")) {
    if (section.Has("roll")) good = reject("roll", "'roll' goes with 'look_at', which is not there");
    fields("orientation", pose.q_WC, {"x, y, z, w"});
    return fields.good() && good;
  }
  if (section.Has("orientation")) good = reject("orientation", "'look_at' and 'orientation' exclude each other");
  glm::dvec3 target(0.0);
  double roll_rad = 0;
  fields("look_at", target, {Unit::length, place, "a point in W"});
  good = fields.good() && good;
  fields("roll", roll_rad, {Unit::angle, Range{-7, 7}, "to the right"});
  if (!good) return false;
  if (glm::distance(target, pose.p_WC) < 1e-9) return reject("look_at", "'look_at' is where the camera is");
  pose.q_WC = LookAt(pose.p_WC, target, roll_rad);
  return true;
}

// Factor of speed with which the path's mean over [0, end_s] is `speed`; 1 without.
double ReadPace(Section& section, const Trajectory& path, double end_s) {
  section.Allow("speed");
  if (!section.Has("speed")) return 1;
  const double mean_speed = MeanSpeed(path, end_s);
  double speed = mean_speed;
  section.Read("speed", speed, Unit::speed, Range::Positive());
  if (mean_speed > 0) return speed / mean_speed;
  section.Reject("speed", "'speed': the path does not move");
  return 1;
}

void ReadShake(Section& section, std::optional<CarrierMotionParams>& shake) {
  section.Allow("shake");
  if (!section.Has("shake")) return;
  Section keys = section.Child("shake");
  shake.emplace();
  keys.RequireChoice("type", shake->model, {{"handheld", Carrier::handheld}, {"drone", Carrier::drone}});
  ReadFields(keys, *shake);
}

template <Carrier model>
MotionDescription ReadRoaming(Section& section, const MotionNames& names) {
  RoamingMotion motion;
  motion.carrier.model = model;
  section.Allow("start");
  if (section.Has("start")) {
    Section start = section.Child("start");
    ReadPose(start, names, motion.start.emplace());
  }
  ReadFields(section, motion);
  return motion;
}

MotionDescription ReadSampled(Section& section, const MotionNames& names) {
  SampledMotion motion;
  Section start = section.Child("start");
  ReadPose(start, names, motion.start);
  section.Allow("walls");
  if (section.Has("walls")) motion.walls.emplace();
  if (ReadFields(section, motion)) section.Reject(Problems(motion));
  return motion;
}

MotionDescription ReadScripted(Section& section, const MotionNames& names) {
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
    good = ReadPose(item, names, key.pose) && has_time && good;
    motion.keys.push_back(key);
  }
  ReadShake(section, motion.shake);
  if (motion.keys.size() < 2) reject(section, "keys", "'trajectory.keys': two key poses are needed at least");
  if (!good) return motion;
  try {
    const SplineTrajectory spline(motion.keys);
    const double pace = ReadPace(section, spline, spline.end_s());
    for (KeyPose& key : motion.keys) key.t_s /= pace;
  } catch (const std::invalid_argument& error) {
    section.Reject("keys", std::string("'trajectory.keys': ") + error.what());
  }
  return motion;
}

MotionDescription ReadRecorded(Section& section, const MotionNames& names) {
  RecordedMotion motion;
  motion.file = ReadFile(section, "file", names.folder);
  motion.place = section.Where("file");
  ReadFields(section, motion);
  section.Allow("start_pose");
  if (section.Has("start_pose")) {
    Section place = section.Child("start_pose");
    ReadPose(place, names, motion.start_pose.emplace());
    if (motion.placing == RecordedMotion::Placing::automatic)
      section.Reject("placing", "'placing: auto' and 'start_pose' exclude each other");
  }
  return motion;
}

template <PathKind kind>
MotionDescription ReadPath(Section& section, const MotionNames& names) {
  PathMotion motion;
  section.RequirePresent("start");
  Section start = section.Child("start");
  const bool good = ReadPose(start, names, motion.start);
  settings::FieldReader fields(section);
  Visit(fields, kind, motion);
  ReadShake(section, motion.shake);
  if (!good) return motion;
  try {
    const PathTrajectory path(motion);
    double longest_s = 0;
    const std::array<Swing*, 3> moving = {&motion.azimuth, &motion.elevation, &motion.along};
    for (const Swing* swing : moving) longest_s = std::max(longest_s, swing->size != 0 ? swing->period_s : 0);
    const double pace = ReadPace(section, path, longest_s);
    for (Swing* swing : moving) swing->period_s /= pace;
  } catch (const std::invalid_argument& error) {
    section.Reject("start", error.what());
  }
  return motion;
}

}  // namespace

glm::dquat LookAt(const glm::dvec3& eye, const glm::dvec3& target, double roll_rad) {
  const glm::dvec3 forward = glm::normalize(target - eye);
  const glm::dvec3 up =
      std::abs(forward.y) < 1 - 1e-12 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, forward.y > 0 ? 1 : -1);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, up));
  const glm::dvec3 down = glm::cross(forward, right);
  return glm::normalize(glm::quat_cast(glm::dmat3(right, down, forward)) * Exp({0, 0, roll_rad}));
}

std::filesystem::path ReadFile(Section& section, const std::string& key, const std::filesystem::path& folder) {
  std::string name;
  return section.Require(key, name) ? folder / name : std::filesystem::path();
}

MotionDescription ReadMotion(Section& section, const MotionNames& names) {
  MotionDescription (*read)(Section&, const MotionNames&) = ReadSampled;
  const bool known = section.RequireChoice("type", read,
                                           {{"sampled", ReadSampled},
                                            {"scripted", ReadScripted},
                                            {"recorded", ReadRecorded},
                                            {"orbit", ReadPath<PathKind::orbit>},
                                            {"half_sphere", ReadPath<PathKind::half_sphere>},
                                            {"rpy", ReadPath<PathKind::rpy>},
                                            {"dolly", ReadPath<PathKind::dolly>},
                                            {"handheld", ReadRoaming<Carrier::handheld>},
                                            {"drone", ReadRoaming<Carrier::drone>},
                                            {"vehicle", ReadRoaming<Carrier::vehicle>}});
  if (known) return read(section, names);
  section.IgnoreRest();
  return SampledMotion{};
}

}  // namespace sim
