// Experiment: a scenario file read for simulator, odometry and prior.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sim/scenario/scenario.h"
#include "tools/base/settings/settings.h"
#include "vo/base/params.h"
#include "vo/geometry/camera.h"

namespace vobench {

using settings::Overrides;

// Prior of pose and velocity, and the camera's error: docs/getting_started.md.
struct PriorSettings {
  enum class Start {
    truth,   // the true pose, and the true velocity with noise of the sigmas below: `run` only
    origin,  // the identity, at rest
  };
  Start start = Start::truth;
  double velocity_sigma = 0.1;      // [m/s]
  double angular_rate_sigma = 0.1;  // [rad/s]
  double focal_error = 0;
  bool shutter_known = true;
};

template <class V>
void Visit(V& v, PriorSettings& p) {
  using settings::Range;
  v("start", p.start, {{"truth", PriorSettings::Start::truth}, {"origin", PriorSettings::Start::origin}},
    "pose and velocity of the first frame: the true ones, the velocity with noise; or the identity, at rest");
  v("velocity_sigma", p.velocity_sigma, {settings::Unit::speed, Range::Positive(), "of the velocity, per axis"});
  v("angular_rate_sigma", p.angular_rate_sigma,
    {settings::Unit::angular_rate, Range::Positive(), "of the angular velocity, per axis"});
  v("focal_error", p.focal_error,
    {Range{-0.9, 9}, "relative error of fx and fy of the camera that the odometry is given"});
  v("shutter_known", p.shutter_known, {"whether the odometry is given the rolling shutter's time"});
}

// Sections `odometry` and `prior`. Absent keys keep their values. Problems go to the section's document.
void ReadOdometry(settings::Section section, vo::Params& params);
void ReadPrior(settings::Section section, PriorSettings& prior);

struct Experiment {
  sim::Scenario scenario;
  vo::Params odometry;
  PriorSettings prior;
  std::string resolved;  // all of it, defaults included: JSON, which is a scenario again
};

// Prior of our systems with the information of images only, as in `track`.
inline constexpr PriorSettings kPriorOfImagesAlone{PriorSettings::Start::origin, 0.5, 0.5};
// Root of the power spectral density of acceleration over the prior depth [1/s^1.5], until both are estimated: with an
// unknown scale only their ratio matters.
inline constexpr double kAccelerationPerDepth = 0.625;

// Settings of `track`: defaults, changed by the document's sections `odometry` and `prior`; its scenario is empty.
// Throws settings::Error.
Experiment ReadTrackSettings(settings::Document document);

// Settings that restrict our systems to images and calibration, as in `track`: no start, no noise fitted to the motion,
// no shutter.
const Overrides& SettingsOfImagesAlone();

// The camera that the odometry is given: the scenario's with its rolling shutter, but for prior.focal_error and
// prior.shutter_known.
vo::Camera CameraForOdometry(const Experiment& experiment);

// Throws BadInput with every problem of all three parts.
Experiment ReadExperiment(const std::filesystem::path& scenario, const Overrides& overrides);
// The same as settings::Error, for callers that find the place of a problem themselves.
Experiment LoadExperiment(const std::filesystem::path& scenario, const Overrides& overrides);

// All settings, from the field tables of their structs: keys as --set takes them, sections in the order of a scenario.
std::vector<settings::FieldRow> SettingsTable();
// docs/settings.md from its first heading of a section on.
std::string SettingsMarkdown();

}  // namespace vobench
