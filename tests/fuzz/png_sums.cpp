#include "tests/fuzz/png_sums.h"

#include <libdeflate.h>

#include <algorithm>
#include <iterator>

namespace fuzz {

void MendPngSums(std::vector<std::uint8_t>& bytes) {
  static constexpr std::uint8_t kSignature[] = {0x89, 'P', 'N', 'G', 0x0d, 0x0a, 0x1a, 0x0a};
  if (bytes.size() < sizeof kSignature || !std::equal(std::begin(kSignature), std::end(kSignature), bytes.begin()))
    return;
  const auto word = [&](std::size_t at) {
    return std::uint32_t{bytes[at]} << 24 | std::uint32_t{bytes[at + 1]} << 16 | std::uint32_t{bytes[at + 2]} << 8 |
           bytes[at + 3];
  };
  std::size_t at = sizeof kSignature;
  while (at + 12 <= bytes.size() && word(at) <= bytes.size() - at - 12) {  // length, type, data, checksum
    const std::size_t length = word(at);
    const std::uint32_t sum = libdeflate_crc32(0, &bytes[at + 4], length + 4);
    for (std::size_t k = 0; k < 4; ++k) bytes[at + 8 + length + k] = static_cast<std::uint8_t>(sum >> (24 - 8 * k));
    at += length + 12;
  }
}

}  // namespace fuzz
