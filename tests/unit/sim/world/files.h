// Small image files, and the folder and the problems of the tests that read meshes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "sim/world/scene.h"
#include "tests/temporary_folder.h"
#include "tools/base/text.h"

namespace sim::test {

using Folder = vobench_test::TemporaryFolder;

// Image file of pseudo-random content, or of one colour.
inline std::string EncodeNoise(const std::string& extension, int width, int height) {
  cv::Mat picture(height, width, CV_8UC3);
  for (int i = 0; i < width * height * 3; ++i) {
    picture.data[i] = static_cast<std::uint8_t>((static_cast<unsigned>(i) * 2654435761u) >> 24);
  }
  std::vector<std::uint8_t> bytes;
  cv::imencode(extension, picture, bytes);
  return {bytes.begin(), bytes.end()};
}

inline std::string EncodeColor(const std::string& extension, int red, int green, int blue) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(extension, cv::Mat(4, 4, CV_8UC3, cv::Scalar(blue, green, red)), bytes);
  return {bytes.begin(), bytes.end()};
}

inline WorldDescription WorldOf(const std::filesystem::path& file) {
  WorldDescription world;
  world.meshes.push_back({file, glm::dvec3(0), {1, 0, 0, 0}, 1, {}, {}});
  return world;
}

// Problems of the SceneError of `load`; empty where it throws none.
template <class Load>
std::vector<std::string> ProblemsOf(const Load& load) {
  try {
    load();
  } catch (const SceneError& error) {
    return error.problems();
  }
  return {};
}

// As one text.
template <class Load>
std::string ProblemTextOf(const Load& load) {
  return base::Join(ProblemsOf(load), "\n");
}

}  // namespace sim::test
