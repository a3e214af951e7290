#include "sim/scenario/path_reader.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <stdexcept>

#include "sim/motion/path.h"
#include "sim/motion/spline.h"
#include "sim/scenario/pose_reader.h"

namespace sim {
namespace {

using settings::Range;
using settings::Section;
using settings::Unit;

constexpr double kTurn = 2 * std::numbers::pi;

void ReadPeriod(Section& section, const std::string& key, double& period_s) {
  section.Require(key, period_s, Unit::time, Range{1e-3, 1e6});
}

double Pace(Section& section, double mean_speed) {
  double speed = mean_speed;
  section.Read("speed", speed, Unit::speed, Range::Positive());
  if (!(mean_speed > 0)) {
    section.Reject("speed", "'speed': the path does not move");
    return 1;
  }
  return speed / mean_speed;
}

}  // namespace

PathMotion ReadPath(Section& section, PathKind kind) {
  PathMotion motion;
  section.RequirePresent("start");
  Section start = section.Child("start");
  bool good = ReadPose(start, motion.start);
  if (kind == PathKind::orbit || kind == PathKind::half_sphere) {
    section.RequirePresent("center");
    ReadVector(section, "center", motion.pivot, Unit::length);
    double period_s = motion.azimuth.period_s, sweep = 0;
    ReadPeriod(section, "period", period_s);
    if (kind == PathKind::orbit) {
      section.Read("sweep", sweep, Unit::angle, Range{0, kTurn});
      motion.azimuth =
          sweep > 0 ? Swing{Swing::Kind::about, sweep / 2, period_s} : Swing{Swing::Kind::steady, kTurn, period_s};
    } else {
      double rise = 0, rise_period_s = 1;
      section.Require("sweep", sweep, Unit::angle, Range{0, kTurn});
      section.Require("rise", rise, Unit::angle, Range{0, kTurn / 4});
      ReadPeriod(section, "rise_period", rise_period_s);
      motion.azimuth = {Swing::Kind::about, sweep / 2, period_s};
      motion.elevation = {Swing::Kind::there_and_back, rise, rise_period_s};
    }
  } else if (kind == PathKind::rpy) {
    std::array<double, 3> angles{}, periods{1, 1, 1};
    section.Require("angles", angles, Unit::angle, Range{-kTurn, kTurn});
    section.Require("periods", periods, Unit::time, Range{1e-3, 1e6});
    motion.roll = {Swing::Kind::about, angles[0], periods[0]};
    motion.pitch = {Swing::Kind::about, angles[1], periods[1]};
    motion.yaw = {Swing::Kind::about, angles[2], periods[2]};
  } else {
    section.RequirePresent("move");
    ReadVector(section, "move", motion.move, Unit::length);
    motion.along = {Swing::Kind::there_and_back, 1, 1};
    ReadPeriod(section, "period", motion.along.period_s);
  }
  if (!good) return motion;
  try {
    const PathTrajectory path(motion);
    section.Allow("speed");
    if (!section.Has("speed")) return motion;
    const std::array<Swing*, 3> moving = {&motion.azimuth, &motion.elevation, &motion.along};
    double longest_s = 0;
    for (const Swing* swing : moving) longest_s = std::max(longest_s, swing->size != 0 ? swing->period_s : 0);
    const double pace = Pace(section, MeanSpeed(path, longest_s));
    for (Swing* swing : moving) swing->period_s /= pace;
  } catch (const std::invalid_argument& error) {
    section.Reject("start", error.what());
  }
  return motion;
}

double ReadPace(Section& section, const ScriptedMotion& motion) {
  section.Allow("speed");
  if (!section.Has("speed")) return 1;
  const SplineTrajectory spline(motion.keys);
  return Pace(section, MeanSpeed(spline, spline.end_s()));
}

}  // namespace sim
