// Purpose: the files of the truth streams as bytes. docs/truth.md has the formats.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace sim {

// OpenEXR, 32-bit floats. One channel "Y", or three, "R", "G", "B", interleaved in `pixels`; rows from the top.
// `packed`: run-length coding (normals of flat surfaces), else raw. Throws std::runtime_error when OpenEXR fails.
std::vector<std::uint8_t> EncodeExr(std::span<const float> pixels, int width, int height, int channels, bool packed);

// Middlebury's .flo: "PIEH", width and height as 32-bit integers, then u, v of each pixel as floats; little endian.
std::vector<std::uint8_t> EncodeFlo(std::span<const float> uv, int width, int height);

// Grey PNG pictures of 8 or 16 bits, the numbers as they are. Throw std::runtime_error when OpenCV fails.
std::vector<std::uint8_t> EncodeGrey8(std::span<const std::uint8_t> pixels, int width, int height);
std::vector<std::uint8_t> EncodeGrey16(std::span<const std::uint16_t> pixels, int width, int height);

}  // namespace sim
