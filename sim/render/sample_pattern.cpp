#include "sim/render/sample_pattern.h"

#include <Random123/philox.h>

namespace sim {

PatternPoint SobolPoint(std::uint32_t i) {
  PatternPoint point;
  std::uint32_t u_direction = 1u << 31, v_direction = 1u << 31;
  for (; i != 0; i >>= 1) {
    if (i & 1u) {
      point.u ^= u_direction;
      point.v ^= v_direction;
    }
    u_direction >>= 1;
    v_direction ^= v_direction >> 1;
  }
  return point;
}

PatternPoint PixelScramble(std::uint64_t key, std::uint32_t x, std::uint32_t y) {
  constexpr std::uint32_t kStream = 0x70697865u;  // "pixe": no other use of the key shares it
  const r123::Philox4x32 philox;
  const r123::Philox4x32::ctr_type counter = {{x, y, 0u, kStream}};
  const r123::Philox4x32::key_type philox_key = {
      {static_cast<std::uint32_t>(key), static_cast<std::uint32_t>(key >> 32)}};
  const r123::Philox4x32::ctr_type bits = philox(counter, philox_key);
  return {bits[0], bits[1]};
}

}  // namespace sim
