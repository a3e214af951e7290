// Counter-based random numbers: a function of their key, independent of the order of evaluation.
// Source:  Random123 (Salmon et al., "Parallel random numbers: as easy as 1, 2, 3"), Philox 4x32-10; Box-Muller
//          normals.
#pragma once

#include <cstdint>

namespace vo {

// Disjoint from the simulator's streams (small numbers): with equal seeds the filter's draws must not equal the image
// noise.
enum class Stream : std::uint32_t { prior_pose = 0x10001, prior_velocity, pose, velocity, resampling };

struct RandomKey {
  std::uint64_t seed = 0;
  Stream stream = Stream::pose;
  std::uint32_t frame = 0;
  std::uint32_t particle = 0;
};

// Uniform on the open interval (0, 1).
double Uniform(const RandomKey& key, std::uint32_t dimension);
// Standard normal.
double Normal(const RandomKey& key, std::uint32_t dimension);

// N independent standard normals, dimensions 0 ... N-1.
template <class Vector>
Vector NormalVector(const RandomKey& key) {
  Vector n;
  for (int i = 0; i < n.size(); ++i) n[i] = Normal(key, static_cast<std::uint32_t>(i));
  return n;
}

}  // namespace vo
