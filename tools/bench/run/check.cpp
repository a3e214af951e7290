#include <fmt/format.h>

#include <cmath>

#include "sim/motion/placement.h"
#include "sim/sensor/sensor.h"
#include "tools/bench/errors.h"
#include "tools/bench/run/run_common.h"
#include "tools/bench/systems/bridge.h"
#include "tools/bench/systems/experiment.h"
#include "tools/bench/text.h"
#include "tools/judge/evaluation/trajectory.h"

namespace vobench {
namespace {

// The first lines, the same for all worlds.
void PrintFrames(const CheckOptions& options, const sim::Scenario& scenario, const Truth& truth) {
  const sim::CameraParams& camera = scenario.camera;
  fmt::print("{}: good\n", options.scenario.string());
  fmt::print("  {} frames of {} x {} at {} Hz, fx {} fy {} cx {} cy {} px\n", truth.poses.size(), camera.width,
             camera.height, scenario.time.rate_hz, camera.fx, camera.fy, camera.cx, camera.cy);
  for (const sim::RigCamera& of : scenario.cameras)
    fmt::print("  camera {}: {} x {}, fx {} px, at ({}, {}, {}) m of the body, {} s late\n", of.name, of.camera.width,
               of.camera.height, of.camera.fx, of.T_BC.p_WC.x, of.T_BC.p_WC.y, of.T_BC.p_WC.z, of.trigger_offset_s);
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

void PrintWorld(const sim::Simulator& simulator) {
  const sim::WorldExtent& world = simulator.extent();
  const auto& [low, high] = std::pair(world.low, world.high);
  fmt::print(
      "  world from ({:.2f}, {:.2f}, {:.2f}) to ({:.2f}, {:.2f}, {:.2f}) m, {} triangles, {:.0f} MB of textures\n",
      low.x, low.y, low.z, high.x, high.y, high.z, world.triangles, 1e-6 * static_cast<double>(world.texture_bytes));
  const sim::Image image = simulator.Render(0).image;
  double sum = 0;
  for (const std::uint8_t v : image.data) sum += v;
  for (const std::uint16_t v : image.wide) sum += v;
  const double most = std::ldexp(1.0, image.bits) - 1,
               count = static_cast<double>(image.data.size() + image.wide.size());
  const double share = sum / count / most;
  fmt::print("  the first frame's mean is {:.0f} % of white, by direct and ambient light alone\n", 100 * share);
  if (share < 0.02 || share > 0.95)
    PrintWarnings(
        {fmt::format("the first frame is nearly {}: see `lights`, sensor.exposure, sensor.gain and "
                     "sensor.white (docs/troubleshooting.md)",
                     share < 0.5 ? "black" : "white")});
}

void PrintRevisits(const sim::Simulator& simulator) {
  constexpr std::size_t kMost = 5;
  const auto revisits =
      sim::Revisits(simulator.trajectory(), sim::Seconds(simulator.StampNs(simulator.frame_count() - 1)));
  fmt::print("  returns to an earlier view: {}", Count(revisits.size(), "time"));
  for (std::size_t i = 0; i < std::min(kMost, revisits.size()); ++i)
    fmt::print(", at {:.1f} s to that at {:.1f} s", revisits[i].t_s, revisits[i].earlier_s);
  fmt::print("{}\n", revisits.size() > kMost ? ", ..." : "");
}

}  // namespace

void Check(const CheckOptions& options) {
  const Experiment experiment = ReadExperiment(options.scenario, options.overrides);
  if (experiment.scenario.points) return CheckPoints(options, experiment.scenario);
  sim::Scenario direct = experiment.scenario;  // baked light is not needed here
  direct.render.light = sim::LightMode::direct;
  const sim::Simulator simulator = LoadSimulator(direct, 1);
  PrintWarnings(simulator.warnings());
  const Truth truth = TruthOf(simulator, 0, simulator.frame_count());
  const sim::Scenario& scenario = experiment.scenario;
  PrintFrames(options, scenario, truth);
  fmt::print("  {:.2f} m of path, {}, {}, seed {}\n", evaluation::PathLength(truth.poses),
             Count(scenario.world.meshes.size(), "mesh file"), Count(scenario.world.lights.size(), "light"),
             scenario.seed);
  PrintWorld(simulator);
  PrintRevisits(simulator);
  PrintSensor(scenario.sensor);
  if (!options.path) return;
  Truth path;
  for (std::int64_t t_ns = 0; t_ns <= simulator.StampNs(simulator.frame_count() - 1); t_ns += 10'000'000)
    Append(t_ns, sim::TruthAt(simulator.trajectory(), sim::Seconds(t_ns)), path);
  evaluation::WriteTrajectory(*options.path, path.poses);
}

}  // namespace vobench
