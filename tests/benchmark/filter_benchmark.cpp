// Time of the filter per frame, against particles, features and lag: one Track in a point world after a warm-up.
// docs/performance.md.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <string>
#include <vector>

#include "sim/points/point_world.h"
#include "source_dir.h"
#include "tools/bench/systems/bridge.h"
#include "tools/bench/systems/experiment.h"
#include "tools/bench/systems/prior.h"
#include "vo/point_odometry.h"

namespace {

using namespace vobench;

struct Setting {
  std::int64_t particles = 8, features = 100, lag = 0;
};

// The same world and the same draws in every repetition.
void TrackOneFrame(benchmark::State& state, const Setting& setting, std::int64_t warm, std::int64_t measured) {
  const Experiment experiment =
      ReadExperiment(VOBENCH_SOURCE_DIR "/scenes/points.yaml",
                     {{"world.points.count", std::to_string(setting.features)},
                      {"time.duration", std::to_string(static_cast<double>(warm + measured + 1) / 30) + " s"},
                      {"odometry.landmark.max_landmarks", "100000"},
                      {"odometry.filter.particles", std::to_string(setting.particles)},
                      {"odometry.filter.lag", std::to_string(setting.lag)}});
  sim::PointWorld world(experiment.scenario);
  vo::PointOdometry odometry(ToOdometry(world.camera().params()), experiment.odometry,
                             PriorOf(experiment.prior, world, 1), 1);
  std::vector<vo::PointFrame> frames;
  while (const auto frame = world.Next()) frames.push_back(ToOdometry(*frame));
  std::size_t next = 0;
  while (next < static_cast<std::size_t>(warm)) odometry.Track(frames[next++]);
  double landmarks = 0, matched = 0;
  for (auto _ : state) {
    const vo::Estimate estimate = odometry.Track(frames.at(next++));
    landmarks += estimate.diagnostics.landmarks;
    matched += estimate.diagnostics.matched;
  }
  const auto count = static_cast<double>(state.iterations());
  state.counters["landmarks"] = landmarks / count;
  state.counters["matched"] = matched / count;
}

constexpr std::int64_t kWarm = 30, kMeasured = 60;
// Number of measured frames: fewer for more particles.
std::int64_t FramesFor(std::int64_t particles) { return std::clamp<std::int64_t>(4096 * 4 / particles, 8, kMeasured); }

void Particles(benchmark::State& state) {
  TrackOneFrame(state, {state.range(0), 100, 0}, 10, FramesFor(state.range(0)));
}
void Features(benchmark::State& state) { TrackOneFrame(state, {8, state.range(0), 0}, kWarm, kMeasured); }
void Lag(benchmark::State& state) { TrackOneFrame(state, {8, 100, state.range(0)}, 22, state.range(0) < 5 ? 20 : 8); }

void Register() {
  const auto common = [](benchmark::internal::Benchmark* b) {
    b->ArgName("n")->Unit(benchmark::kMillisecond)->Repetitions(5)->ReportAggregatesOnly();
  };
  for (const std::int64_t n : {1, 8, 64, 512, 1000, 4096}) {
    auto* b = benchmark::RegisterBenchmark("Particles", Particles)->Arg(n)->Iterations(FramesFor(n));
    common(b);
  }
  for (const std::int64_t n : {25, 50, 100, 200, 400, 800}) {
    common(benchmark::RegisterBenchmark("Features", Features)->Arg(n)->Iterations(kMeasured));
  }
  for (const std::int64_t n : {0, 1, 2, 5, 10, 20}) {
    common(benchmark::RegisterBenchmark("Lag", Lag)->Arg(n)->Iterations(n < 5 ? 20 : 8));
  }
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  Register();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
