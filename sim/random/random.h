// Counter-based random numbers (Philox4x32-10): functions of their key, in any order of work.
// Source: Salmon et al. 2011, "Parallel random numbers: as easy as 1, 2, 3"; the Random123 library.
#pragma once

#include <Random123/philox.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>

namespace sim {

// Purposes of random numbers. Numbers of different streams are independent.
enum class Stream : std::uint32_t {
  position_noise = 1,
  orientation_noise = 2,
  ray_jitter = 3,
  pixel_noise = 4,
  light_path = 5,
  fixed_pattern = 8,
  depth_noise = 9,
  carrier = 10,          // offsets of a carried camera,
  carrier_burst = 11,    // how strongly they are driven,
  carrier_course = 12,   // its course,
  carrier_gaze = 13,     // where it looks,
  carrier_attempt = 14,  // the seeds of further attempts,
  carrier_place = 15,    // and where it may lie
  start_velocity = 16,
  point_place = 17,    // landmarks without images: where they are,
  point_noise = 18,    // the noise of their views,
  point_outlier = 19,  // which are replaced, and by what,
  point_loss = 20,     // and which are missing,
  point_scale = 21,    // what all their inverse depths have in common
  imu_noise = 40,
  imu_walk = 41,
  landmark_place = 42,  // through which pixels the tracked surface points are seen first
  object_motion = 43,   // the seed of each moving object's own motion
  scenario = 44,        // values that the scenario gives as distributions
  rig_camera = 45       // the seed of each further camera of a rig
};

using Words = std::array<std::uint32_t, 4>;

inline Words RandomWords(std::uint64_t seed, Stream stream, std::uint32_t frame, std::uint32_t pixel,
                         std::uint32_t dimension) {
  const r123::Philox4x32::key_type key{{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)}};
  const r123::Philox4x32::ctr_type counter{{dimension, pixel, frame, static_cast<std::uint32_t>(stream)}};
  const r123::Philox4x32::ctr_type words = r123::Philox4x32()(counter, key);
  return {words[0], words[1], words[2], words[3]};
}

// A seed for a separate sequence of numbers.
inline std::uint64_t SeedOf(const Words& words) { return (std::uint64_t{words[0]} << 32) | words[1]; }

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
// The same for each axis of two vectors, keyed by (seed, stream, frame, pixel, axis).
inline std::array<glm::dvec3, 2> NormalVectors(std::uint64_t seed, Stream stream, std::uint32_t frame,
                                               std::uint32_t pixel) {
  std::array<glm::dvec3, 2> vectors{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto z = Normals(RandomWords(seed, stream, frame, pixel, static_cast<std::uint32_t>(axis)));
    for (std::size_t i = 0; i < 2; ++i) vectors[i][axis] = z[i];
  }
  return vectors;
}

// ln of x in [0.5, 2^32], and the cosine and sine of `turns_24` * 2^-24 turns, to 3e-7: polynomials of Cephes
// (Moshier), written without branches so that loops over them become vector code, and with the same result on every
// machine.
inline float LogFast(float x) {
  constexpr float kRootHalf = 0.70710678f;
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(x);
  const float half_to_one = std::bit_cast<float>((bits & 0x007fffffu) | 0x3f000000u);
  const bool low = half_to_one < kRootHalf;
  const float exponent = static_cast<float>(static_cast<std::int32_t>(bits >> 23) - 126 - (low ? 1 : 0));
  const float z = (low ? half_to_one + half_to_one : half_to_one) - 1.0f;
  float y = 7.0376836292e-2f;
  y = y * z - 1.1514610310e-1f;
  y = y * z + 1.1676998740e-1f;
  y = y * z - 1.2420140846e-1f;
  y = y * z + 1.4249322787e-1f;
  y = y * z - 1.6668057665e-1f;
  y = y * z + 2.0000714765e-1f;
  y = y * z - 2.4999993993e-1f;
  y = y * z + 3.3333331174e-1f;
  return exponent * 0.69314718f + (z + (y * z - 0.5f) * z * z);
}
inline std::array<float, 2> CosSinFast(std::uint32_t turns_24) {
  const std::int32_t n = static_cast<std::int32_t>(turns_24), quarter = (n + (1 << 21)) >> 22;  // the nearest one
  const float x = 6.2831853f * 0x1p-24f * static_cast<float>(n - (quarter << 22)), x2 = x * x;
  const float s = x + x * x2 * ((-1.9515295891e-4f * x2 + 8.3321608736e-3f) * x2 - 1.6666654611e-1f);
  const float c =
      1.0f - 0.5f * x2 + x2 * x2 * ((2.443315711809948e-5f * x2 - 1.388731625493765e-3f) * x2 + 4.166664568298827e-2f);
  const bool odd = (quarter & 1) != 0;
  const float cosine = odd ? s : c, sine = odd ? c : s;
  return {((quarter + 1) & 2) != 0 ? -cosine : cosine, (quarter & 2) != 0 ? -sine : sine};
}

// In single precision, for noise in pictures. |z| < 6.8.
inline std::array<float, 2> NormalsFast(std::uint32_t a, std::uint32_t b) {
  constexpr float kLogOf2To32 = 22.180710f;
  const float log_u = LogFast(static_cast<float>(a) + 0.5f) - kLogOf2To32;
  const float radius = std::sqrt(std::max(0.0f, -2.0f * log_u));
  const auto [cosine, sine] = CosSinFast(b >> 8);
  return {radius * cosine, radius * sine};
}

}  // namespace sim
