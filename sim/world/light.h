// Purpose: what lights a world. Radiance, irradiance and intensity are linear RGB in one arbitrary but common unit: a
// white
//          Lambert surface (albedo 1) under irradiance pi has radiance 1, and radiance 1 is what the sensor calls white
//          at unit exposure. Directions and positions are in W.
#pragma once

#include <glm/vec3.hpp>
#include <variant>
#include <vector>

namespace sim {

// The same radiance from everywhere, never occluded: adds albedo * radiance to every surface. It stands for the light
// that bounces about; there is no global illumination.
struct AmbientLight {
  glm::dvec3 radiance{1.0};
};

// Infinitely far: hard shadows. A surface whose normal makes the angle a with the light gets irradiance * cos(a).
struct SunLight {
  glm::dvec3 direction{0.0, -1.0, 0.0};  // in which the light travels; any length but zero
  glm::dvec3 irradiance{1.0};            // on a surface that faces the sun
};

// Irradiance = intensity * cos(a) / distance^2: hard shadows.
struct PointLight {
  glm::dvec3 position{0.0};
  glm::dvec3 intensity{1.0};
};

// A parallelogram with corner `corner` and sides `side_u`, `side_v` that shines on the side of cross(side_u, side_v),
// with the same radiance in all directions: soft shadows. Sample i of n of an exposure uses the i-th point of a fixed
// n-point pattern on the light, the same for all pixels and frames: no noise, but at n = 1 a hard shadow. It is not
// itself seen.
struct RectLight {
  glm::dvec3 corner{0.0};
  glm::dvec3 side_u{1.0, 0.0, 0.0};
  glm::dvec3 side_v{0.0, 0.0, 1.0};
  glm::dvec3 radiance{1.0};
};

using Light = std::variant<AmbientLight, SunLight, PointLight, RectLight>;

}  // namespace sim
