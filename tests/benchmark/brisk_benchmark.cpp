// Time to search the windows of 200 landmarks at every pixel, by window side and instruction set; and that of OpenCV's
// BRISK, which estimates an orientation at each pixel as well. docs/performance.md.
#include <benchmark/benchmark.h>

#include <opencv2/features2d.hpp>
#include <string>
#include <vector>

#include "tests/unit/vo/texture.h"
#include "vo/features/brisk.h"

namespace {

constexpr int kLandmarks = 200;

Eigen::Vector2i Centre(int n) { return {80 + n * 37 % 480, 80 + n * 53 % 320}; }

std::vector<vo::PixelRun> Window(const Eigen::Vector2i& centre, int side) {
  std::vector<vo::PixelRun> window;
  for (int y = -side / 2; y <= side / 2; ++y)
    window.push_back({centre.y() + y, centre.x() - side / 2, centre.x() + side / 2});
  return window;
}

void Ours(benchmark::State& state, vo::InstructionSet set) {
  const cv::Mat image = vo_test::Texture(1).Image(640, 480, {0, 0});
  const int side = static_cast<int>(state.range(0));
  const vo::BriskSampler sampler(12 / vo::kBriskBasicDiameter * Eigen::Matrix2d::Identity());
  vo::BriskImage brisk;
  vo::Descriptor wanted{};
  for (auto _ : state) {
    brisk.Set(image);
    for (int n = 0; n < kLandmarks; ++n) {
      wanted[0] = static_cast<std::uint64_t>(n);
      benchmark::DoNotOptimize(brisk.Nearest(wanted, sampler, Window(Centre(n), side), set));
    }
  }
}

void OpenCv(benchmark::State& state) {
  const cv::Mat image = vo_test::Texture(1).Image(640, 480, {0, 0});
  const int side = static_cast<int>(state.range(0));
  const auto brisk = cv::BRISK::create();
  for (auto _ : state) {
    std::vector<cv::KeyPoint> keypoints;
    for (int n = 0; n < kLandmarks; ++n)
      for (const vo::PixelRun& run : Window(Centre(n), side))
        for (int x = run.first_x; x <= run.last_x; ++x)
          keypoints.emplace_back(static_cast<float>(x), static_cast<float>(run.y), 12.f);
    cv::Mat descriptors;
    brisk->compute(image, keypoints, descriptors);
    benchmark::DoNotOptimize(descriptors.data);
  }
}

}  // namespace

int main(int count, char** arguments) {
  for (const vo::InstructionSet set : vo::AvailableInstructionSets())
    benchmark::RegisterBenchmark((std::string("Ours/") + vo::Name(set)).c_str(), Ours, set)
        ->Arg(5)
        ->Arg(9)
        ->Arg(17)
        ->Arg(49)
        ->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark("OpenCV", OpenCv)->Arg(5)->Arg(9)->Arg(17)->Unit(benchmark::kMillisecond);
  benchmark::Initialize(&count, arguments);
  benchmark::RunSpecifiedBenchmarks();
}
