// Purpose: the light of a world that was computed once: what each point of each surface receives.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/light/lattice.h"
#include "sim/world/light.h"

namespace sim {

// Samples of irradiance / pi (the radiance of a white surface), packed (sim/light/shared_exponent.h). Each layer has
// them for all triangles in order, of each the front's lattice and then the back's.
struct BakedLight {
  std::vector<TriangleResolution> resolutions;  // by triangle
  std::vector<Flicker> layers;         // the light of lamps with the same flicker is one layer; the first is steady
  std::vector<std::uint32_t> samples;  // layers.size() * (lattices of all triangles)
};

}  // namespace sim
