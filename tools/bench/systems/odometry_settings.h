// Purpose: the sections `odometry:` and `prior:` of a scenario or a settings file, bound to plain structs.
#pragma once

#include "tools/base/settings/settings.h"
#include "vo/base/params.h"

namespace vobench {

// Reads what is given, leaves the rest at the defaults of vo/base/params.h. Problems go to the section's document.
void ReadOdometry(settings::Section section, vo::Params& params);

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
}

// As ReadOdometry; `prior` holds the defaults at first.
void ReadPrior(settings::Section section, PriorSettings& prior);

}  // namespace vobench
