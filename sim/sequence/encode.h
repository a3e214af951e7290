// Encoders of the truth streams that are no PNG files: OpenEXR and Middlebury .flo (docs/truth.md).
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

}  // namespace sim
