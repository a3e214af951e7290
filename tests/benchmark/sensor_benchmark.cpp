// CPU time of a frame at one sample a pixel, by stages, on one thread: rays of the image, sensor, rays of the depth,
// and the two image files. scenes/room.yaml, 640 x 480. docs/performance.md.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <string>
#include <vector>

#include "sim/sensor/sensor.h"
#include "sim/sequence/encode.h"
#include "sim/simulator.h"
#include "source_dir.h"

namespace {

constexpr std::int64_t kFrame = 40;

const sim::Simulator& Room() {
  static const sim::Simulator room(
      sim::LoadScenario(VOBENCH_SOURCE_DIR "/scenes/room.yaml", {{"sensor.time_samples", "1"}}), 1);
  return room;
}

void Frame(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(Room().Render(kFrame).image.data.data());
}

void SensorOfFrame(benchmark::State& state) {
  sim::RadianceImage radiance{640, 480, std::vector<float>(640 * 480 * 3)};
  for (std::size_t i = 0; i < radiance.rgb.size(); ++i) radiance.rgb[i] = static_cast<float>(i % 1000) / 1000;
  const sim::Sensor sensor(sim::LoadScenario(VOBENCH_SOURCE_DIR "/scenes/room.yaml").sensor, 1);
  std::int64_t frame = 0;
  for (auto _ : state) benchmark::DoNotOptimize(sensor.Capture(radiance, frame++).data.data());
}

void Depth(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(Room().Depth(kFrame).data());
}

void ImageFile(benchmark::State& state) {
  const sim::Image image = Room().Render(kFrame).image;
  for (auto _ : state) benchmark::DoNotOptimize(sim::EncodePng(image).data());
}

void DepthFile(benchmark::State& state) {
  const std::vector<float> depth_m = Room().Depth(kFrame);
  for (auto _ : state) benchmark::DoNotOptimize(sim::EncodeDepthPng(depth_m, 640, 480).data());
}

BENCHMARK(Frame)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
BENCHMARK(SensorOfFrame)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
BENCHMARK(ImageFile)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
BENCHMARK(Depth)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
BENCHMARK(DepthFile)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

}  // namespace

int main(int argc, char** argv) {
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
