// PNG encoder.
// Source: W3C, Portable Network Graphics, third edition: chunks (5), Paeth filter (9.4), zlib stream (10).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace sim {

// A picture without loss: rows from the top; channels 1 (grey) or 3 (red, green, blue); 8 or 16 bits each. Every row
// has the Paeth filter: of the five it makes rendered images, noisy ones too, and depth smallest. Compressed by
// libdeflate at level 1 (docs/performance.md); the bytes depend on the pixels and libdeflate's version alone. Throws
// std::invalid_argument when width, height and channels are not those of `samples`, or the file would exceed 2 GB.
std::vector<std::uint8_t> EncodePng(int width, int height, int channels, std::span<const std::uint8_t> samples);
std::vector<std::uint8_t> EncodePng(int width, int height, int channels, std::span<const std::uint16_t> samples);

}  // namespace sim
