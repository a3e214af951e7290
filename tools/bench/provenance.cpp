#include "tools/bench/provenance.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <Eigen/Core>
#include <ctime>
#include <opencv2/core/version.hpp>

namespace vobench {

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

}  // namespace vobench
