// Purpose: a folder of small files that goes away with the test.
#pragma once

#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace sim::test {

class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "vobench_world_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make " + name);
    path_ = name;
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  const std::filesystem::path& path() const { return path_; }

  std::filesystem::path Write(const std::string& name, const std::string& content) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name, std::ios::binary) << content;
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

// A picture file of random-looking content, or of one colour.
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

}  // namespace sim::test
