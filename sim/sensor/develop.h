// Image processing after the sensor: camera response function, demosaicing, JPEG compression.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "sim/sensor/description.h"
#include "sim/sensor/image.h"

namespace sim {

// Camera response R(x), light x and code in [0, 1], and its inverse: x itself, the sRGB curve, or that of
// light_of_code, linear in between.
double EncodeResponse(const SensorParams& params, double x);
double DecodeResponse(const SensorParams& params, double code);

// The inverse response of a file in TUM's format, pcalib.txt: the light of each code, in any unit, never decreasing.
// Throws std::runtime_error that names the file, with all problems.
std::vector<double> ReadResponse(const std::filesystem::path& file);

// code = round(255 R(x)), R(x) = x or the sRGB curve; exact at every threshold R^-1((code + 1/2) / 255) as rounded to
// float.
class ResponseCurve {
 public:
  explicit ResponseCurve(Response response);

  // x in [0, 1]; what is beyond is clipped, NaN is 0.
  std::uint8_t Encode(float x) const {
    const float light = x > 0.0f ? std::min(x, 1.0f) : 0.0f;
    const std::uint8_t code = guess_[static_cast<std::size_t>(light * kCells)];
    return static_cast<std::uint8_t>(code + (light >= threshold_[code] ? 1 : 0));
  }

 private:
  static constexpr int kCells = 4096;             // narrower than the range of any code
  std::array<float, 256> threshold_{};            // from code i to i + 1
  std::array<std::uint8_t, kCells + 1> guess_{};  // the code at the lower end of each cell
};

// The channel that the pixel's filter lets through: RGGB, red at (0, 0). 0: red, 1: green, 2: blue.
inline int BayerChannel(int x, int y) { return (x & 1) + (y & 1); }

// Colour from a picture behind a Bayer filter, by OpenCV's edge-aware interpolation or its bilinear one. In a picture
// of one pixel a side a colour that has no pixel is that of the pixels that are there.
Image Demosaic(const Image& mosaic, bool edge_aware);

// The picture as it comes back from a JPEG file of this quality (1 ... 100), chroma at half resolution. 8 bits.
Image ThroughJpeg(const Image& image, int quality);

}  // namespace sim
