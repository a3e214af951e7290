// Purpose: the sections `odometry:` and `prior:` of a scenario or a settings file, bound to plain structs.
#pragma once

#include "tools/base/settings/settings.h"
#include "vo/base/params.h"

namespace vobench {

// Reads what is given, leaves the rest at the defaults of vo/base/params.h. Problems go to the section's document.
void ReadOdometry(settings::Section section, vo::Params& params);

// What the odometry is told before the first frame; docs/getting_started.md.
struct PriorSettings {
  enum class Start {
    truth,   // the true pose, and the true velocity with noise of the sigmas below: `run` only
    origin,  // the identity, at rest
  };
  Start start = Start::truth;
  double velocity_sigma = 0.1;      // per axis [m/s]
  double angular_rate_sigma = 0.1;  // per axis [rad/s]
  double focal_error = 0;           // of the camera it is told: fx and fy are too large by this share
};

// As ReadOdometry; `prior` holds the defaults at first.
void ReadPrior(settings::Section section, PriorSettings& prior);

}  // namespace vobench
