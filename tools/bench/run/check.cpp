#include <fmt/format.h>

#include <cmath>

#include "sim/motion/placement.h"
#include "sim/sensor/sensor.h"
#include "sim/simulator.h"
#include "tools/base/files.h"
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

double LastStamp(const sim::Simulator& simulator) {
  return sim::Seconds(simulator.StampNs(simulator.frame_count() - 1));
}

void PrintRevisits(const sim::Simulator& simulator) {
  constexpr std::size_t kMost = 5;
  const std::vector<sim::Revisit> revisits = sim::Revisits(simulator.trajectory(), LastStamp(simulator));
  std::string text;
  for (std::size_t i = 0; i < std::min(kMost, revisits.size()); ++i) {
    text += fmt::format("{} at {:.1f} s ({:.1f} s)", i == 0 ? ":" : ",", revisits[i].t_s, revisits[i].earlier_s);
  }
  fmt::print("  returns {} times to an earlier view{}{}\n", revisits.size(), text,
             revisits.size() > kMost ? ", ..." : "");
}

// Every 10 ms, in TUM's format.
void WritePath(const std::filesystem::path& file, const sim::Simulator& simulator) {
  constexpr std::int64_t kStep_ns = 10'000'000;
  std::string text = "# timestamp tx ty tz qx qy qz qw\n";
  const std::int64_t last_ns = simulator.StampNs(simulator.frame_count() - 1);
  for (std::int64_t t_ns = 0; t_ns <= last_ns; t_ns += kStep_ns) {
    const sim::Truth at = sim::TruthAt(simulator.trajectory(), sim::Seconds(t_ns));
    text += fmt::format("{:.2f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f}\n", sim::Seconds(t_ns), at.p_WC.x,
                        at.p_WC.y, at.p_WC.z, at.q_WC.x, at.q_WC.y, at.q_WC.z, at.q_WC.w);
  }
  base::WriteFileAndFolders(file, text);
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
  PrintRevisits(simulator);
  PrintSensor(scenario.sensor);
  if (options.path) WritePath(*options.path, simulator);
}

}  // namespace vobench
