#include "sim/world/sky.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <opencv2/imgcodecs.hpp>
#include <span>
#include <stdexcept>
#include <string>

#include "sim/world/image_file.h"
#include "sim/world/texture.h"
#include "tools/base/files.h"
#include "tools/base/limits/picture.h"

namespace sim {
namespace {

// Without OpenCV, which reads OpenEXR only where the environment enables it. In OpenCV's order of colours.
cv::Mat ReadExr(const std::filesystem::path& path) {
  try {
    Imf::InputFile file(path.c_str());
    const Imath::Box2i window = file.header().dataWindow();
    const Imf::ChannelList& channels = file.header().channels();
    const bool grey = channels.findChannel("Y") != nullptr && channels.findChannel("R") == nullptr;
    const std::vector<const char*> names = grey ? std::vector{"Y"} : std::vector{"B", "G", "R"};
    cv::Mat picture(window.max.y - window.min.y + 1, window.max.x - window.min.x + 1, grey ? CV_32FC1 : CV_32FC3);
    Imf::FrameBuffer buffer;
    const auto step = static_cast<std::ptrdiff_t>(picture.elemSize()),
               row = static_cast<std::ptrdiff_t>(picture.step[0]);
    char* base = reinterpret_cast<char*>(picture.data) - row * window.min.y - step * window.min.x;
    for (const char* name : names) {
      const Imf::Channel* channel = channels.findChannel(name);
      if (channel == nullptr) throw std::runtime_error(std::string("there is no channel ") + name);
      if (channel->xSampling != 1 || channel->ySampling != 1)
        throw std::runtime_error(std::string("channel ") + name + " is subsampled");
      buffer.insert(name, Imf::Slice(Imf::FLOAT, base, static_cast<std::size_t>(step), static_cast<std::size_t>(row)));
      base += sizeof(float);
    }
    file.setFrameBuffer(buffer);
    file.readPixels(window.min.y, window.max.y);
    return picture;
  } catch (const std::exception& error) {
    throw std::runtime_error(path.string() + ": cannot be read: " + error.what());
  }
}

cv::Mat ReadPicture(const std::filesystem::path& file) {
  const std::optional<std::string> bytes = base::ReadFile(file);
  if (!bytes) throw std::runtime_error(file.string() + ": cannot be opened");
  const std::span<const std::uint8_t> whole = base::AsBytes(*bytes);
  const bool is_exr = bytes->starts_with("\x76\x2f\x31\x01");
  const std::string problem = is_exr ? limits::ExrProblem(whole) : limits::PictureProblem(whole);
  if (!problem.empty()) throw std::runtime_error(file.string() + (is_exr ? ": cannot be read: " : ": ") + problem);
  if (is_exr) return ReadExr(file);
  try {
    return DecodeMatrix(whole, cv::IMREAD_UNCHANGED);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(file.string() + ": " + error.what());
  }
}

}  // namespace

glm::dvec3 Sky::Radiance(const glm::dvec3& d) const {
  if (picture.empty()) {
    return glm::dvec3(horizon) + std::max(0.0, d.y) * glm::dvec3(zenith - horizon) +
           std::max(0.0, -d.y) * glm::dvec3(ground - horizon);
  }
  const double s = 0.5 + turn + std::atan2(d.x, -d.z) / (2 * std::numbers::pi);
  const double x = (s - std::floor(s)) * width - 0.5;
  const double y = std::acos(std::clamp(d.y, -1.0, 1.0)) / std::numbers::pi * height - 0.5;
  const double x0 = std::floor(x), y0 = std::floor(y), fx = x - x0, fy = y - y0;
  const auto at = [&](double column, double row) {
    const int i = (static_cast<int>(column) + width) % width, j = std::clamp(static_cast<int>(row), 0, height - 1);
    return glm::dvec3(
        picture[static_cast<std::size_t>(j) * static_cast<std::size_t>(width) + static_cast<std::size_t>(i)]);
  };
  return (1 - fy) * ((1 - fx) * at(x0, y0) + fx * at(x0 + 1, y0)) +
         fy * ((1 - fx) * at(x0, y0 + 1) + fx * at(x0 + 1, y0 + 1));
}

Sky LoadSky(const SkyDescription& description) {
  Sky sky{description.zenith, description.horizon, description.ground, 0, 0, {}, description.turn};
  if (description.file.empty()) return sky;
  const cv::Mat read = ReadPicture(description.file);
  if (read.channels() != 1 && read.channels() != 3 && read.channels() != 4) {
    throw std::runtime_error(description.file.string() + ": " + std::to_string(read.channels()) +
                             " channels; 1, 3 or 4 are read");
  }
  const bool linear = read.depth() == CV_32F;
  const double full = read.depth() == CV_16U ? 65535.0 : read.depth() == CV_8U ? 255.0 : 1.0;
  cv::Mat numbers;
  read.convertTo(numbers, CV_32F, 1.0 / full);
  sky.width = read.cols;
  sky.height = read.rows;
  const int channels = read.channels();
  for (int y = 0; y < read.rows; ++y) {
    const float* row = numbers.ptr<float>(y);
    for (int x = 0; x < read.cols; ++x, row += channels) {
      glm::dvec3 rgb = channels == 1 ? glm::dvec3(row[0]) : glm::dvec3(row[2], row[1], row[0]);
      for (int c = 0; c < 3; ++c) {
        if (!std::isfinite(rgb[c]) || rgb[c] < 0) {
          throw std::runtime_error(description.file.string() + ": pixel (" + std::to_string(x) + ", " +
                                   std::to_string(y) + ") is negative or not finite: " + std::to_string(rgb[c]));
        }
        if (!linear) rgb[c] = SrgbToLinear(rgb[c]);
      }
      sky.picture.emplace_back(description.strength * rgb);
    }
  }
  return sky;
}

}  // namespace sim
