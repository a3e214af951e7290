#include <fmt/format.h>

#include <cmath>

#include "sim/sensor/sensor.h"
#include "sim/simulator.h"
#include "tools/bench/errors.h"
#include "tools/bench/run/commands.h"
#include "tools/bench/systems/bridge.h"
#include "tools/bench/systems/experiment.h"
#include "tools/judge/evaluation/trajectory.h"

namespace vobench {

namespace {

// The first lines, the same for all worlds.
void PrintFrames(const CheckOptions& options, const sim::Scenario& scenario, const Truth& truth) {
  const sim::CameraParams& camera = scenario.camera;
  fmt::print("{}: good\n", options.scenario.string());
  fmt::print("  {} frames of {} x {} at {} Hz, fx {} fy {} cx {} cy {} px\n", truth.poses.size(), camera.width,
             camera.height, scenario.time.rate_hz, camera.fx, camera.fy, camera.cx, camera.cy);
  for (const auto& [key, value] : scenario.drawn) fmt::print("  drawn: {} = {}\n", key, value);
}

void CheckPoints(const CheckOptions& options, const sim::Scenario& scenario) {
  sim::PointWorld world = Input([&] { return sim::PointWorld(scenario); });
  PrintWarnings(world.Warnings());
  Truth truth;
  std::size_t views = 0;
  while (const auto frame = world.Next()) {
    Append(frame->stamp_ns, frame->truth, truth);
    views += frame->observations.size();
  }
  PrintFrames(options, scenario, truth);
  fmt::print("  {:.2f} m of path, {} landmarks, {:.1f} of them seen in a frame, seed {}\n",
             evaluation::PathLength(truth.poses), world.landmarks().size(),
             static_cast<double>(views) / static_cast<double>(truth.poses.size()), scenario.seed);
}

// In the terms of camera data sheets (docs/sensor.md).
void PrintSensor(const sim::SensorParams& sensor) {
  const sim::EmvaFigures emva = sim::Emva(sensor);
  fmt::print(
      "  sensor (EMVA 1288): gain {:.4g} DN/e, dark noise {:.3g} e, saturation {:.0f} e = {:.0f} photons,\n"
      "    threshold {:.3g} photons, SNR at most {:.3g} ({:.1f} dB), dynamic range {:.1f} dB, PRNU {:.2g} %, DSNU "
      "{:.2g} e\n",
      emva.system_gain, emva.dark_noise_e, emva.saturation_e, emva.saturation_p, emva.sensitivity_p, emva.snr_max,
      20 * std::log10(emva.snr_max), 20 * std::log10(emva.dynamic_range), emva.prnu_percent, emva.dsnu_e);
}

}  // namespace

void Check(const CheckOptions& options) {
  const Experiment experiment = ReadExperiment(options.scenario, options.overrides);
  if (experiment.scenario.points) return CheckPoints(options, experiment.scenario);
  const sim::Simulator simulator = Input([&] { return sim::Simulator(experiment.scenario, 1); });
  PrintWarnings(simulator.warnings());
  const Truth truth = TruthOf(simulator, 0, simulator.frame_count());
  const sim::Scenario& scenario = experiment.scenario;
  PrintFrames(options, scenario, truth);
  fmt::print("  {:.2f} m of path, {} meshes, {} lights, seed {}\n", evaluation::PathLength(truth.poses),
             scenario.world.meshes.size(), scenario.world.lights.size(), scenario.seed);
  PrintSensor(scenario.sensor);
}

}  // namespace vobench
