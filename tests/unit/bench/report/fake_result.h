// Synthetic result folder: a camera on a spiral, estimates that drift from it, with the covariance of the drift or a
// smaller one.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/bench/result/metrics_json.h"
#include "tools/bench/result/run_json.h"

namespace vobench::report {

struct FakeSystem {
  std::string name = "rb2pf";
  double drift = 0.01;    // of the position [m/s^0.5], of the orientation half as many [rad/s^0.5]
  double claimed = 1;     // standard deviations claimed / true ones
  double scale = 1;       // of the estimate
  bool reissued = false;  // the start: half of the answers' errors
};

struct FakeOptions {
  int frames = 90;
  int seeds = 3;
  bool truth = true;
  bool pictures = true;
  std::vector<FakeSystem> systems = {{"rb2pf", 0.01, 1, 1.02, true}, {"rbpf", 0.03, 0.5, 0.93}};
};

// Writes everything but report.html; returns the metrics.
std::vector<RunMetrics> WriteFakeResult(const std::filesystem::path& out, const FakeOptions& options);

}  // namespace vobench::report
