// CPU time to encode a frame, and its size, against OpenCV's PNG encoder: a frame of the room with noise, and its
// depth. Then the wall time of a second of the room at one ray per pixel, where writing has its largest share: rendered
// only, and rendered and written. docs/performance.md.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <thread>
#include <vector>

#include "sim/sequence/encode.h"
#include "sim/sequence/layout.h"
#include "sim/sequence/writer.h"
#include "sim/simulator.h"
#include "source_dir.h"

namespace {

struct Example {
  sim::Image image;
  std::vector<float> depth_m;
};

const Example& Room() {
  static const Example example = [] {
    const sim::Simulator room(sim::LoadScenario(VOBENCH_SOURCE_DIR "/scenes/room.yaml"), 1);
    return Example{room.Render(60).image, room.Depth(60)};
  }();
  return example;
}

void Size(benchmark::State& state, std::size_t bytes) { state.counters["bytes"] = static_cast<double>(bytes); }

void Colour(benchmark::State& state) {
  const sim::Image& image = Room().image;
  std::vector<std::uint8_t> file;
  for (auto _ : state) file = sim::EncodePng(image);
  Size(state, file.size());
}

// Includes the conversion from RGB to OpenCV's BGR.
void ColourOpenCv(benchmark::State& state) {
  const sim::Image& image = Room().image;
  const cv::Mat rgb(image.height, image.width, CV_8UC3, const_cast<std::uint8_t*>(image.data.data()));
  std::vector<std::uint8_t> file;
  for (auto _ : state) {
    cv::Mat bgr;
    cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
    cv::imencode(".png", bgr, file);
  }
  Size(state, file.size());
}

void Depth(benchmark::State& state) {
  const Example& room = Room();
  std::vector<std::uint8_t> file;
  for (auto _ : state) file = sim::EncodeDepthPng(room.depth_m, room.image.width, room.image.height);
  Size(state, file.size());
}

void DepthOpenCv(benchmark::State& state) {
  const Example& room = Room();
  const cv::Mat metres(room.image.height, room.image.width, CV_32FC1, const_cast<float*>(room.depth_m.data()));
  std::vector<std::uint8_t> file;
  for (auto _ : state) {
    cv::Mat fifths_of_millimetres;
    metres.convertTo(fifths_of_millimetres, CV_16U, 5000);
    cv::imencode(".png", fifths_of_millimetres, file);
  }
  Size(state, file.size());
}

constexpr int kJobs = 2;
constexpr std::int64_t kFrames = 30;

const sim::Simulator& OneRayPerPixel() {
  static const sim::Simulator room(
      sim::LoadScenario(VOBENCH_SOURCE_DIR "/scenes/room.yaml", {{"sensor.time_samples", "1"}}), kJobs);
  return room;
}

void RenderOnly(benchmark::State& state) {
  const sim::Simulator& room = OneRayPerPixel();
  for (auto _ : state) {
    std::atomic<std::int64_t> next = 0;
    const auto work = [&] {
      for (std::int64_t k; (k = next++) < kFrames;) {
        benchmark::DoNotOptimize(room.Render(k).image.data.data());
        benchmark::DoNotOptimize(room.Depth(k).data());
      }
    };
    std::vector<std::jthread> threads;
    for (int i = 0; i < kJobs; ++i) threads.emplace_back(work);
  }
}

void RenderAndWrite(benchmark::State& state) {
  const sim::Simulator& room = OneRayPerPixel();
  const auto folder = std::filesystem::temp_directory_path() / ("write_benchmark-" + std::to_string(getpid()));
  for (auto _ : state) {
    {
      sim::SequenceWriter writer(room, folder, {sim::Layout::tum, 0, kFrames, "benchmark"}, kJobs,
                                 sim::SequenceWriter::Start::fresh);
      while (writer.Wait() > 0) {
      }
      writer.Finish();
    }
    state.PauseTiming();
    std::filesystem::remove_all(folder);
    state.ResumeTiming();
  }
}

BENCHMARK(Colour)->Unit(benchmark::kMillisecond);
BENCHMARK(ColourOpenCv)->Unit(benchmark::kMillisecond);
BENCHMARK(Depth)->Unit(benchmark::kMillisecond);
BENCHMARK(DepthOpenCv)->Unit(benchmark::kMillisecond);
BENCHMARK(RenderOnly)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();
BENCHMARK(RenderAndWrite)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();

}  // namespace

BENCHMARK_MAIN();
