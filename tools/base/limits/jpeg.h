// Entropy-coded data of JPEG files. Private to limits.
// Source: ITU T.81, annexes B, C and F.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace limits {

// What is missing at the end, or damaged within the data of baseline pictures, which decoders complete with grey or
// other colours; empty: nothing. Bytes after the end are ignored.
std::string JpegProblem(std::span<const std::uint8_t> file);

}  // namespace limits
