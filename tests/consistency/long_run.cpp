#include "tests/consistency/long_run.h"

#include <unistd.h>

#include <algorithm>
#include <ctime>
#include <fstream>
#include <string>
#include <unordered_map>

#include "sim/world/point_world.h"
#include "tools/evaluation/statistics.h"
#include "tools/vobench/bridge.h"
#include "tools/vobench/experiment.h"
#include "tools/vobench/prior.h"
#include "vo/point_odometry.h"

namespace long_run {
namespace {

using namespace vobench;

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

}  // namespace

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
    Truth start;
    Append(world.StampNs(0), world.TruthAt(0), start);
    prior = PriorOf(experiment.prior, experiment.scenario.motion, start, 1);
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

double MedianTime(const std::vector<Frame>& frames, std::size_t first, std::size_t last) {
  std::vector<double> times;
  for (std::size_t k = first; k < last; ++k) times.push_back(frames[k].cpu_s);
  return evaluation::Median(times);
}

}  // namespace long_run
