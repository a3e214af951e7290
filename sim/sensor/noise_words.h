// Random words of many samples of a picture, for its noise: those of RandomWords (random.h), in vector code.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace sim {

struct NoiseWords {
  static constexpr std::size_t kCount = 256;
  alignas(32) std::array<std::array<std::uint32_t, kCount>, 4> word;

  // Of samples in a row from `first_sample` on, one of each pixel or, in color, three.
  void Draw(std::uint64_t seed, std::uint32_t frame, std::uint32_t first_pixel, std::uint32_t first_sample, bool color);
};

// Philox4x32-10: counters are replaced by their random words. Versions that this machine runs, the fastest last.
using PhiloxKernel = void(std::uint64_t seed, NoiseWords& counters);
std::vector<PhiloxKernel*> PhiloxKernels();

}  // namespace sim
