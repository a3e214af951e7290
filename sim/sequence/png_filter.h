// Paeth filter and byte order of PNG rows, as vector code (AVX2 where available); integers, so with equal results.
// Source: W3C, Portable Network Graphics, third edition, 9.4.
#pragma once

#include <cstddef>
#include <cstdint>

namespace sim {

// filtered[i] = row[i] - whichever of left, above and upper left is nearest to left + above - upper left, for the
// `size` bytes of a row; `above` is the row before, zeros for the first. `pixel`: bytes per pixel, the distance to the
// left.
void PaethFilter(const std::uint8_t* row, const std::uint8_t* above, std::size_t size, std::size_t pixel,
                 std::uint8_t* filtered);

// Samples of 16 bits as PNG has them.
void MostSignificantFirst(const std::uint16_t* samples, std::size_t count, std::uint8_t* bytes);

}  // namespace sim
