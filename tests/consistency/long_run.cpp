#include "tests/consistency/long_run.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <functional>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <vector>

#include "sim/points/point_world.h"
#include "sim/simulator.h"
#include "source_dir.h"
#include "tools/bench/systems/bridge.h"
#include "tools/bench/systems/experiment.h"
#include "tools/bench/systems/prior.h"
#include "vo/odometry.h"
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

// Pipe from a child process that runs `write`. Objects are sent as raw memory: both processes run on one machine.
class Stream {
 public:
  explicit Stream(const std::function<void(Stream&)>& write) {
    int ends[2];
    if (pipe(ends) != 0) throw std::runtime_error("no pipe");
    child_ = fork();
    if (child_ < 0) throw std::runtime_error("no process");
    close(ends[child_ == 0 ? 0 : 1]);
    file_ = fdopen(ends[child_ == 0 ? 1 : 0], child_ == 0 ? "wb" : "rb");
    if (child_ > 0) return;
    write(*this);
    std::fclose(file_);
    _exit(0);  // without the parent's destructors and exit handlers
  }
  ~Stream() {
    std::fclose(file_);
    waitpid(child_, nullptr, 0);
  }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  template <class T>
  void Put(const T* items, std::size_t count) {
    if (std::fwrite(items, sizeof(T), count, file_) != count) _exit(1);  // the reader is gone
  }
  template <class T>
  void Put(const T& item) {
    Put(&item, 1);
  }
  template <class T>
  bool Get(T* items, std::size_t count) {
    return std::fread(items, sizeof(T), count, file_) == count;
  }
  template <class T>
  bool Get(T& item) {
    return Get(&item, 1);
  }

 private:
  pid_t child_ = 0;
  std::FILE* file_ = nullptr;
};

struct Memory {
  std::size_t early = 0, most = 0;  // resident bytes at frame `early`; maximum since
  void Add(bool is_early, std::size_t bytes) {
    if (is_early) early = most = bytes;
    if (early > 0) most = std::max(most, bytes);
  }
};

// CPU time per frame and resident memory of a run.
class Watch {
 public:
  explicit Watch(const Length& length) : length_(length), last_(length.window), last_reference_(length.window) {}
  void Add(double cpu_s) {
    const double reference_s = ReferenceSeconds();
    if (frames_ >= length_.early && first_.size() < length_.window) {
      first_.push_back(cpu_s);
      first_reference_.push_back(reference_s);
    }
    last_[frames_ % length_.window] = cpu_s;
    last_reference_[frames_ % length_.window] = reference_s;
    if (IsLookedAt()) memory_.Add(frames_ == length_.early, ResidentBytes());
    ++frames_;
  }
  bool IsLookedAt() const { return frames_ % 100 == 0 || frames_ == length_.early || frames_ + 1 == length_.frames; }
  bool IsEarly() const { return frames_ == length_.early; }

  void Expect() {
    ASSERT_EQ(frames_, length_.frames);
    const double first = Quiet(first_), last = Quiet(last_);
    const double machine = Quiet(last_reference_) / Quiet(first_reference_);
    EXPECT_LT(last, 1.25 * first * machine) << "[s] per frame";
    ExpectFlat(memory_);
    std::cout << frames_ << " frames. ms per frame: " << 1e3 * first << " at first, " << 1e3 * last
              << " at last, of a fixed calculation " << machine
              << " times; resident MB: " << 1e-6 * static_cast<double>(memory_.early) << " at frame " << length_.early
              << ", then at most " << 1e-6 * static_cast<double>(memory_.most) << '\n';
  }
  void ExpectFlat(const Memory& memory) const {
    EXPECT_LT(static_cast<double>(memory.most),
              (length_.frames > 10'000 ? 1.01 : 1.02) * static_cast<double>(memory.early))
        << "resident bytes";
  }

 private:
  // Tenth percentile: the time of a frame without disturbance by other processes.
  static double Quiet(std::vector<double> times) {
    const auto tenth = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 10);
    std::nth_element(times.begin(), tenth, times.end());
    return *tenth;
  }

  // CPU time of a fixed calculation; other processes on the same core slow it down as much as a frame.
  double ReferenceSeconds() {
    const double before = CpuSeconds();
    reference_.compute(matrix_);
    return CpuSeconds() - before;
  }

  Length length_;
  std::size_t frames_ = 0;
  std::vector<double> first_, last_, first_reference_, last_reference_;
  Eigen::MatrixXd matrix_ = Eigen::MatrixXd::Ones(100, 100) + 100 * Eigen::MatrixXd::Identity(100, 100);
  Eigen::LLT<Eigen::MatrixXd> reference_{100};
  Memory memory_;
};

std::string Duration(const Length& length) { return std::to_string(static_cast<double>(length.frames) / 30) + " s"; }

}  // namespace

void ExpectNothingGrowsOnPoints(const Length& length) {
  const Experiment experiment =
      ReadExperiment(VOBENCH_SOURCE_DIR "/scenes/points.yaml", {{"time.duration", Duration(length)},
                                                                {"trajectory.position_return", "1"},
                                                                {"trajectory.orientation_return", "1"}});
  const sim::PointWorld start(experiment.scenario);
  Stream world([&](Stream& out) {
    sim::PointWorld frames(experiment.scenario);
    while (const auto made = frames.Next()) {
      const vo::PointFrame frame = ToOdometry(*made);
      out.Put(frame.stamp_ns);
      out.Put(frame.observations.size());
      out.Put(frame.observations.data(), frame.observations.size());
    }
  });
  vo::PointOdometry odometry(ToOdometry(start.camera().params()), experiment.odometry,
                             PriorOf(experiment.prior, start, 1), 1);
  const auto memory = static_cast<std::size_t>(experiment.odometry.landmark.forget_after);
  std::unordered_map<std::int64_t, std::size_t> last_seen;
  Watch watch(length);
  vo::PointFrame frame;
  for (std::size_t k = 0, count = 0; world.Get(frame.stamp_ns) && world.Get(count); ++k) {
    frame.observations.resize(count);
    ASSERT_TRUE(world.Get(frame.observations.data(), count));
    const double before = CpuSeconds();
    const vo::Estimate estimate = odometry.Track(frame);
    watch.Add(CpuSeconds() - before);
    for (const vo::PointObservation& seen : frame.observations) last_seen[seen.id] = k;
    std::erase_if(last_seen, [&](const auto& entry) { return entry.second + memory <= k; });
    ASSERT_EQ(estimate.diagnostics.landmarks, static_cast<int>(last_seen.size())) << k;
  }
  watch.Expect();
}

void ExpectNothingGrowsOnImages(const Length& length) {
  const Experiment experiment =
      ReadExperiment(VOBENCH_SOURCE_DIR "/tests/consistency/long_flight.yaml", {{"time.duration", Duration(length)}});
  const sim::CameraParams& camera = experiment.scenario.camera;
  const std::size_t bytes = static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height) * 3;
  Stream world([&](Stream& out) {
    sim::Simulator simulator(experiment.scenario, 1);
    while (const auto made = simulator.Next()) {
      const vo::Frame frame = ToOdometry(*made);
      out.Put(frame.stamp_ns);
      out.Put(ResidentBytes());
      out.Put(frame.image.data, bytes);
    }
  });
  const vo::Prior prior = [&] {
    const sim::Simulator start(experiment.scenario, 1);
    return PriorOf(experiment.prior, experiment.scenario.motion, TruthOf(start, 0), 1);
  }();
  vo::Odometry odometry(CameraOf(experiment.scenario), experiment.odometry, prior, 1);
  Watch watch(length);
  Memory simulator;
  std::size_t simulator_bytes = 0, tracked = 0;
  vo::Frame frame;
  while (world.Get(frame.stamp_ns) && world.Get(simulator_bytes)) {
    frame.image.create(camera.height, camera.width, CV_8UC3);
    ASSERT_TRUE(world.Get(frame.image.data, bytes));
    simulator.Add(watch.IsEarly(), simulator_bytes);
    const double before = CpuSeconds();
    tracked += odometry.Track(frame).diagnostics.tracked();
    watch.Add(CpuSeconds() - before);
  }
  watch.Expect();
  watch.ExpectFlat(simulator);
  std::cout << "the simulator's: " << 1e-6 * static_cast<double>(simulator.early) << " and "
            << 1e-6 * static_cast<double>(simulator.most) << "; frames tracked: " << tracked << '\n';
  EXPECT_GT(static_cast<double>(tracked), 0.9 * static_cast<double>(length.frames));
}

}  // namespace long_run
