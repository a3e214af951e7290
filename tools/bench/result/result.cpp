#include "tools/bench/result/result.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <Eigen/Core>
#include <ctime>
#include <opencv2/core/version.hpp>

#include "tools/bench/report/report.h"
#include "tools/bench/systems/systems.h"

namespace vobench {

const std::set<std::string>& ResultNames() {
  static const std::set<std::string> names = [] {
    std::set<std::string> all = {"run.json",     "metrics.json",       "anees.csv",  "verdict.csv",   "report.html",
                                 "estimate.txt", "covariance.txt",     "frames.csv", "frames",        "landmarks.csv",
                                 "truth.txt",    "truth_velocity.txt", "ranks.csv",  "pictures.json", "truth"};
    for (const std::string& system : SystemNames()) all.insert(system);
    return all;
  }();
  return names;
}

double Clock::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

std::string Clock::started_utc() const {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::chrono::system_clock::to_time_t(wall_)));
}

std::map<std::string, std::string> Versions() {
  return {{"vobench", VOBENCH_VERSION},
          {"compiler", fmt::format("GCC-compatible {}", __VERSION__)},
          {"Eigen", fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
          {"OpenCV", CV_VERSION}};
}

evaluation::JudgeOptions JudgeOptionsOf(const PriorSettings& prior) {
  evaluation::JudgeOptions how;
  if (prior.start == PriorSettings::Start::origin) how.gauge = evaluation::Gauge::first_pose;
  return how;
}

void WriteTruth(const std::filesystem::path& run_folder, const Truth& truth) {
  evaluation::WriteTrajectory(run_folder / "truth.txt", truth.poses);
  if (truth.velocities) evaluation::WriteVelocities(run_folder / "truth_velocity.txt", *truth.velocities);
}

void WriteResult(const std::filesystem::path& folder, const report::RunDescription& description,
                 const std::vector<report::JudgedRun>& judged) {
  report::WriteRunJson(folder, description);
  if (!judged.empty()) report::WriteMetricsJson(folder, judged);
  report::WriteReport(folder);
}

}  // namespace vobench
