#include <fmt/format.h>

#include "sim/simulator.h"
#include "tools/evaluation/trajectory.h"
#include "tools/vobench/bridge.h"
#include "tools/vobench/commands.h"
#include "tools/vobench/errors.h"
#include "tools/vobench/experiment.h"

namespace vobench {

void Check(const CheckOptions& options) {
  const Experiment experiment = ReadExperiment(options.scenario, options.overrides);
  const sim::Simulator simulator = Input([&] { return sim::Simulator(experiment.scenario, 1); });
  PrintWarnings(simulator.warnings());
  Truth truth;
  for (std::int64_t k = 0; k < simulator.frame_count(); ++k) Append(simulator.StampNs(k), simulator.TruthAt(k), truth);
  const sim::Scenario& scenario = experiment.scenario;
  const sim::CameraParams& camera = scenario.camera;
  fmt::print("{}: good\n", options.scenario.string());
  fmt::print("  {} frames of {} x {} at {} Hz, fx {} fy {} cx {} cy {} px\n", simulator.frame_count(), camera.width,
             camera.height, scenario.time.rate_hz, camera.fx, camera.fy, camera.cx, camera.cy);
  fmt::print("  {:.2f} m of path, {} meshes, {} lights, seed {}\n", evaluation::PathLength(truth.poses),
             scenario.world.meshes.size(), scenario.world.lights.size(), scenario.seed);
}

}  // namespace vobench
