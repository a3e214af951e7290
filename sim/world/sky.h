// Sky: the radiance of rays that meet no surface. Uniform, a gradient, or an environment map; it is a light source
// where light is baked.
#pragma once

#include <filesystem>
#include <glm/vec3.hpp>
#include <vector>

namespace sim {

// Linear radiance towards a unit direction d in W, whose up is +y. Without a picture: blended linearly in d.y between
// `horizon` (d.y = 0) and `zenith` (1) or `ground` (-1). With one: equirectangular, its middle towards -z, +x to the
// right of it, the upper row at the zenith; `turn` more turns the world to the right; bilinear.
struct Sky {
  glm::vec3 zenith{0.0f}, horizon{0.0f}, ground{0.0f};
  int width = 0, height = 0;       // of the picture; 0: none
  std::vector<glm::vec3> picture;  // linear radiance, rows from the top
  double turn = 0.0;               // in turns

  glm::dvec3 Radiance(const glm::dvec3& direction) const;
};

// How a scenario describes one.
struct SkyDescription {
  glm::dvec3 zenith{0.0}, horizon{0.0}, ground{0.0};
  std::filesystem::path file;  // empty: none. Radiance HDR or EXR (linear), or whatever else OpenCV reads (sRGB-coded)
  double strength = 1.0;       // factor on the picture
  double turn = 0.0;
};

// Throws std::runtime_error naming the file when it cannot be read or holds what is not light (negative, not finite).
Sky LoadSky(const SkyDescription& description);

}  // namespace sim
