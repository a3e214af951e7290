// Purpose: random numbers that are functions of their key, so that no order of work can change them: Philox4x32-10
// (Salmon et
//          al. 2011, "Parallel random numbers: as easy as 1, 2, 3"; the Random123 library).
#pragma once

#include <Random123/philox.h>

#include <array>
#include <cmath>
#include <cstdint>

namespace sim {

// What a number is for. Numbers of different streams are independent.
enum class Stream : std::uint32_t { position_noise = 1, orientation_noise = 2, ray_jitter = 3, pixel_noise = 4 };

using Words = std::array<std::uint32_t, 4>;

inline Words RandomWords(std::uint64_t seed, Stream stream, std::uint32_t frame, std::uint32_t pixel,
                         std::uint32_t dimension) {
  const r123::Philox4x32::key_type key{{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)}};
  const r123::Philox4x32::ctr_type counter{{dimension, pixel, frame, static_cast<std::uint32_t>(stream)}};
  const r123::Philox4x32::ctr_type words = r123::Philox4x32()(counter, key);
  return {words[0], words[1], words[2], words[3]};
}

// In (0, 1), never 0 or 1, with 32 bits.
inline double Uniform(std::uint32_t word) { return (word + 0.5) * 0x1p-32; }
// The same with 53 bits.
inline double Uniform(std::uint32_t high, std::uint32_t low) {
  const std::uint64_t bits = (std::uint64_t{high} << 32) | low;
  return (static_cast<double>(bits >> 12) + 0.5) * 0x1p-52;
}

// Two independent standard normal numbers of two uniform ones (Box and Muller 1958).
inline std::array<double, 2> Normals(double u1, double u2) {
  constexpr double kTwoPi = 6.283185307179586476925286766559;
  const double radius = std::sqrt(-2.0 * std::log(u1)), angle = kTwoPi * u2;
  return {radius * std::cos(angle), radius * std::sin(angle)};
}
inline std::array<double, 2> Normals(const Words& words) {
  return Normals(Uniform(words[0], words[1]), Uniform(words[2], words[3]));
}
// In single precision, for noise in pictures. |z| < 6.7.
inline std::array<float, 2> NormalsFast(std::uint32_t a, std::uint32_t b) {
  const float u1 = static_cast<float>(Uniform(a));
  const float radius = std::sqrt(-2.0f * std::log(u1 < 1.0f ? u1 : 0x1.fffffep-1f));
  const float angle = 6.2831853f * (static_cast<float>(b >> 8) * 0x1p-24f);
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

}  // namespace sim
