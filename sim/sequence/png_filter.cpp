#include "sim/sequence/png_filter.h"

#include <algorithm>

#if defined(__x86_64__) && !defined(__SANITIZE_THREAD__)  // which crashes where the choice is made, before it is loaded
#define VOBENCH_FOR_AVX2_TOO __attribute__((target_clones("default", "avx2")))
#else
#define VOBENCH_FOR_AVX2_TOO
#endif

namespace sim {
namespace {

inline std::int16_t Size(std::int16_t x) { return std::max(x, static_cast<std::int16_t>(-x)); }

}  // namespace

// Left of the first pixel are zeros: of those three neighbours the one above is nearest.
VOBENCH_FOR_AVX2_TOO
void PaethFilter(const std::uint8_t* row, const std::uint8_t* above, std::size_t size, std::size_t pixel,
                 std::uint8_t* __restrict filtered) {
  for (std::size_t i = 0; i < std::min(pixel, size); ++i) filtered[i] = static_cast<std::uint8_t>(row[i] - above[i]);
  // Sixteen bits and no jumps, so that the compiler makes vectors of it.
  for (std::size_t i = pixel; i < size; ++i) {
    const std::int16_t a = row[i - pixel], b = above[i], c = above[i - pixel];
    const std::int16_t to_a = static_cast<std::int16_t>(b - c), to_b = static_cast<std::int16_t>(a - c);
    const std::int16_t from_a = Size(to_a), from_b = Size(to_b), from_c = Size(static_cast<std::int16_t>(to_a + to_b));
    const std::int16_t nearest_of_b_c = from_b <= from_c ? b : c;
    const std::int16_t nearest = from_a <= std::min(from_b, from_c) ? a : nearest_of_b_c;
    filtered[i] = static_cast<std::uint8_t>(row[i] - nearest);
  }
}

VOBENCH_FOR_AVX2_TOO
void MostSignificantFirst(const std::uint16_t* samples, std::size_t count, std::uint8_t* __restrict bytes) {
  for (std::size_t i = 0; i < count; ++i) {
    bytes[2 * i] = static_cast<std::uint8_t>(samples[i] >> 8);
    bytes[2 * i + 1] = static_cast<std::uint8_t>(samples[i]);
  }
}

}  // namespace sim
