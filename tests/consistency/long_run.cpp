#include "tests/consistency/long_run.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <ctime>
#include <fstream>
#include <iostream>
#include <string>
#include <unordered_map>
#include <vector>

#include "sim/world/point_world.h"
#include "tools/vobench/bridge.h"
#include "tools/vobench/experiment.h"
#include "tools/vobench/prior.h"
#include "vo/point_odometry.h"

namespace long_run {
namespace {

using namespace vobench;

struct Frame {
  double cpu_s = 0;  // of the thread
  int landmarks = 0;
  int allowed = 0;                 // different points seen in this frame and the forget_after - 1 before it
  std::size_t resident_bytes = 0;  // every 100 frames, else 0
  bool finite = false;
};

double CpuSeconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

std::size_t ResidentBytes() {
  std::ifstream file("/proc/self/statm");
  std::size_t total = 0, resident = 0;
  file >> total >> resident;
  return resident * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

std::vector<Frame> Play(std::size_t count) {
  const Experiment experiment =
      ReadExperiment(VOBENCH_SOURCE_DIR "/scenes/points.yaml",
                     {{"time.duration", std::to_string(static_cast<double>(count) / 30) + " s"},
                      {"trajectory.position_return", "1"},
                      {"trajectory.orientation_return", "1"}});
  std::vector<vo::PointFrame> frames;
  vo::Prior prior;
  vo::Camera camera;
  {
    sim::PointWorld world(experiment.scenario);
    prior = PriorOf(experiment.prior, world, 1);
    camera = ToOdometry(world.camera().params());
    while (const auto frame = world.Next()) frames.push_back(ToOdometry(*frame));
  }
  vo::PointOdometry odometry(camera, experiment.odometry, prior, 1);
  const std::size_t memory = static_cast<std::size_t>(experiment.odometry.landmark.forget_after);
  std::unordered_map<std::int64_t, std::size_t> last_seen;
  last_seen.reserve(100'000);
  std::vector<Frame> result(frames.size());
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const double before = CpuSeconds();
    const vo::Estimate estimate = odometry.Track(frames[k]);
    result[k].cpu_s = CpuSeconds() - before;
    for (const vo::PointObservation& seen : frames[k].observations) last_seen[seen.id] = k;
    std::erase_if(last_seen, [&](const auto& entry) { return entry.second + memory <= k; });
    result[k].allowed = static_cast<int>(last_seen.size());
    result[k].landmarks = estimate.diagnostics.landmarks;
    result[k].finite = estimate.covariance.allFinite() && estimate.pose.p_WC.allFinite();
    if (k % 100 == 0 || k + 1 == frames.size()) result[k].resident_bytes = ResidentBytes();
  }
  return result;
}

// What nine tenths of the frames of [first, last) take longer than: as the filter is when nothing else disturbs it.
double QuietTime(const std::vector<Frame>& frames, std::size_t first, std::size_t last) {
  std::vector<double> times;
  for (std::size_t k = first; k < last; ++k) times.push_back(frames[k].cpu_s);
  const auto tenth = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 10);
  std::nth_element(times.begin(), tenth, times.end());
  return *tenth;
}

}  // namespace

void ExpectNothingGrows(std::size_t count, std::size_t early, std::size_t window) {
  const auto frames = Play(count);
  ASSERT_EQ(frames.size(), count);
  for (std::size_t k = 0; k < count; ++k) {
    ASSERT_TRUE(frames[k].finite) << k;
    ASSERT_EQ(frames[k].landmarks, frames[k].allowed) << k;
  }
  // The first second has no landmarks out of view yet.
  const double first = QuietTime(frames, 60, 60 + window), last = QuietTime(frames, count - window, count);
  EXPECT_LT(last, 1.25 * first) << "[s] per frame";
  const auto then = static_cast<double>(frames[early].resident_bytes),
             now = static_cast<double>(frames.back().resident_bytes);
  EXPECT_LT(now, 1.02 * then) << "resident bytes";
  std::cout << "ms per frame: " << 1e3 * first << " at first, " << 1e3 * last << " at last; resident MB: " << then / 1e6
            << " and " << now / 1e6 << "; landmarks at last: " << frames.back().landmarks << '\n';
}

}  // namespace long_run
