// Wall time of one exposure with 1 and with 16 time samples, by renderer: scenes/room.yaml, 640 x 480.
#include <benchmark/benchmark.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <stdexcept>

#include "sim/motion/trajectory.h"
#include "sim/render/rasteriser.h"
#include "sim/render/ray_tracer.h"
#include "sim/scenario/scenario.h"
#include "source_dir.h"

namespace {

const sim::Scenario& Room() {
  static const sim::Scenario room = sim::LoadScenario(std::filesystem::path(VOBENCH_SOURCE_DIR) / "scenes/room.yaml");
  return room;
}

std::unique_ptr<sim::Renderer> Drawn(const sim::Scene& scene, sim::GlPlatform platform) {
  sim::RasteriserOptions options;
  options.platform = platform;
  return sim::MakeRasteriser(scene, options);
}

using Make = std::function<std::unique_ptr<sim::Renderer>(const sim::Scene&)>;

// time_samples, readout time [ms].
void Frame(benchmark::State& state, const Make& make) {
  std::unique_ptr<sim::Renderer> renderer;
  try {
    renderer = make(sim::LoadScene(Room().world));
  } catch (const std::runtime_error& error) {
    state.SkipWithError(error.what());
    return;
  }
  const sim::Camera camera(Room().camera);
  const auto motion = sim::MakeTrajectory(Room().motion, 1, Room().time.duration_s, 0.1);
  sim::Exposure exposure;
  exposure.middle_s = 2.0;
  exposure.exposure_s = Room().sensor.exposure_s;
  exposure.time_samples = static_cast<int>(state.range(0));
  exposure.row_delay_s = 1e-3 * static_cast<double>(state.range(1)) / 479;
  sim::RadianceImage image;
  renderer->Expose(camera, *motion, exposure, 1, image);  // shadow maps
  for (auto _ : state) renderer->Expose(camera, *motion, exposure, 1, image);
}

void Cases(benchmark::internal::Benchmark* b) {
  b->ArgNames({"time_samples", "readout_ms"})
      ->Args({1, 0})
      ->Args({16, 0})
      ->Args({16, 20})
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime();
}

BENCHMARK_CAPTURE(Frame, ray_tracer, [](const sim::Scene& scene) { return sim::MakeRayTracer(scene); })->Apply(Cases);
BENCHMARK_CAPTURE(Frame, egl, [](const sim::Scene& scene) { return Drawn(scene, sim::GlPlatform::egl); })->Apply(Cases);
BENCHMARK_CAPTURE(Frame, osmesa, [](const sim::Scene& scene) {
  return Drawn(scene, sim::GlPlatform::osmesa);
})->Apply(Cases);

}  // namespace

BENCHMARK_MAIN();
