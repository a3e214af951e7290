// Experiment: a scenario file read for simulator, odometry and prior.
#pragma once

#include <filesystem>
#include <string>

#include "sim/scenario/scenario.h"
#include "tools/base/settings/settings.h"
#include "tools/bench/systems/odometry_settings.h"
#include "vo/geometry/camera.h"

namespace vobench {

using settings::Overrides;

struct Experiment {
  sim::Scenario scenario;
  vo::Params odometry;
  PriorSettings prior;
  std::string resolved;  // all of it, defaults included: JSON, which is a scenario again
};

// The camera as the odometry is told it: the scenario's with its rolling shutter, but for prior.focal_error.
vo::Camera CameraForOdometry(const Experiment& experiment);

// Throws BadInput with every problem of all three parts.
Experiment ReadExperiment(const std::filesystem::path& scenario, const Overrides& overrides);
// The same as settings::Error, for those who know better where a problem comes from.
Experiment LoadExperiment(const std::filesystem::path& scenario, const Overrides& overrides);

}  // namespace vobench
