// Files of a sequence, in memory; encoders of images: PNG, OpenEXR, Middlebury .flo (docs/truth.md).
// Source: W3C, Portable Network Graphics, third edition: chunks (5), Paeth filter (9.4), zlib stream (10).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sim/sensor/image.h"

namespace sim {

struct StreamFile {
  std::string path;  // relative to the sequence's folder, with '/', without blanks: "rgb/0.033333333.png"
  std::vector<std::uint8_t> bytes;  // all of it
};

inline StreamFile TextFile(std::string path, std::string_view text) {
  return {std::move(path), {text.begin(), text.end()}};
}

// A picture without loss: rows from the top; channels 1 (grey) or 3 (red, green, blue); 8 or 16 bits each. Every row
// has the Paeth filter: of the five it makes rendered images, noisy ones too, and depth smallest. Compressed by
// libdeflate at level 1 (docs/performance.md); the bytes depend on the pixels and libdeflate's version alone. Throws
// std::invalid_argument when width, height and channels are not those of `samples`, or the file would exceed 2 GB.
std::vector<std::uint8_t> EncodePng(int width, int height, int channels, std::span<const std::uint8_t> samples);
std::vector<std::uint8_t> EncodePng(int width, int height, int channels, std::span<const std::uint16_t> samples,
                                    const std::string& comment = "");
std::vector<std::uint8_t> EncodePng(const Image& image);
// Depth: 16 bits, round(5000 Z), 0 where Z is 0 or beyond kDepthRange_m. The number of out-of-range pixels, if any, is
// stored in a comment (tEXt).
constexpr double kDepthRange_m = 65535.5 / 5000;
std::vector<std::uint8_t> EncodeDepthPng(std::span<const float> depth_m, int width, int height);

// Rows of PNG as vector code (AVX2 where available); integers, so with equal results.
// filtered[i] = row[i] - whichever of left, above and upper left is nearest to left + above - upper left, for the
// `size` bytes of a row; `above`: the row before, zeros for the first. `pixel`: bytes per pixel, the step to the left.
void PaethFilter(const std::uint8_t* row, const std::uint8_t* above, std::size_t size, std::size_t pixel,
                 std::uint8_t* filtered);

// Samples of 16 bits as PNG has them.
void MostSignificantFirst(const std::uint16_t* samples, std::size_t count, std::uint8_t* bytes);

// OpenEXR, 32-bit floats. One channel "Y", or three, "R", "G", "B", interleaved in `pixels`; rows from the top.
// `packed`: run-length coding (normals of flat surfaces), else raw. Throws std::runtime_error when OpenEXR fails.
std::vector<std::uint8_t> EncodeExr(std::span<const float> pixels, int width, int height, int channels, bool packed);

// Middlebury's .flo: "PIEH", width and height as 32-bit integers, then u, v of each pixel as floats; little endian.
std::vector<std::uint8_t> EncodeFlo(std::span<const float> uv, int width, int height);

}  // namespace sim
