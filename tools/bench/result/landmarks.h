// landmarks.csv of a run folder: the map after the last frame.
// Source: docs/result_folder.md.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace vobench {

struct Landmark {
  std::int64_t id = 0;
  Eigen::Vector3d X_W = Eigen::Vector3d::Zero();      // [m]
  double inverse_depth = 0, inverse_depth_sigma = 0;  // [1/m]
  bool permanent = false;
};

// Throws std::runtime_error.
void WriteLandmarks(const std::filesystem::path& run_folder, const std::vector<Landmark>& landmarks);
// None where there is no such file; inverse depths are not read. Throws evaluation::InputError with every problem.
std::vector<Landmark> ReadLandmarks(const std::filesystem::path& run_folder);

}  // namespace vobench
