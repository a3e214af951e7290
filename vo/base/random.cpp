#include "vo/base/random.h"

#include <cmath>
#include <numbers>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wconversion"
#include <Random123/philox.h>
#pragma GCC diagnostic pop

namespace vo {
namespace {

r123::Philox4x32::ctr_type Draw(const RandomKey& key, std::uint32_t dimension) {
  const r123::Philox4x32::ctr_type counter = {
      {key.frame, key.particle, dimension, static_cast<std::uint32_t>(key.stream)}};
  const r123::Philox4x32::key_type seed = {
      {static_cast<std::uint32_t>(key.seed), static_cast<std::uint32_t>(key.seed >> 32)}};
  return r123::Philox4x32()(counter, seed);
}

// 53 random bits, shifted by half a step: never 0, never 1.
double ToUnit(std::uint32_t high, std::uint32_t low) {
  const std::uint64_t bits = ((std::uint64_t{high} << 32) | low) >> 11;
  return (static_cast<double>(bits) + 0.5) * 0x1.0p-53;
}

}  // namespace

double Uniform(const RandomKey& key, std::uint32_t dimension) {
  const auto r = Draw(key, dimension);
  return ToUnit(r[0], r[1]);
}

double Normal(const RandomKey& key, std::uint32_t dimension) {
  const auto r = Draw(key, dimension);
  const double radius = std::sqrt(-2.0 * std::log(ToUnit(r[0], r[1])));
  return radius * std::cos(2.0 * std::numbers::pi * ToUnit(r[2], r[3]));
}

}  // namespace vo
