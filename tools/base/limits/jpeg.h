// Entropy-coded data of JPEG files. Private to limits.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace limits {

// What libjpeg finds damaged in the data of a whole file that is not progressive, and completes with other colours;
// empty: nothing.
std::string JpegDataProblem(std::span<const std::uint8_t> file);

}  // namespace limits
