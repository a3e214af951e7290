// Purpose: PNG files, several times as fast as OpenCV writes them.
// Source:  W3C, Portable Network Graphics, third edition: chunks (5), Paeth filter (9.4), zlib stream (10).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace sim {

// A picture without loss: rows from the top; channels 1 (grey) or 3 (red, green, blue); 8 or 16 bits each. Every row
// has the Paeth filter: of the five it makes rendered images, noisy ones too, and depth smallest, and as vector code it
// costs a tenth of the compression (ISA-L, level 1). Throws std::invalid_argument when width, height and channels are
// not those of `samples`, or the file would exceed 2 GB.
//
// The bytes depend on the pixels alone, with every x86-64 processor that has SSE4.2 (those since 2008);
// docs/performance.md says how that was found out.
std::vector<std::uint8_t> EncodePng(int width, int height, int channels, std::span<const std::uint8_t> samples);
std::vector<std::uint8_t> EncodePng(int width, int height, int channels, std::span<const std::uint16_t> samples);

}  // namespace sim
