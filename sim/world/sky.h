// Sky: the radiance of rays that meet no surface. Uniform, a gradient, or an environment map; it is a light source
// where light is baked.
#pragma once

#include <filesystem>
#include <glm/vec3.hpp>
#include <numbers>
#include <vector>

#include "sim/world/light.h"

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

// Sky of a scenario: a picture, or three colours.
struct SkyDescription {
  glm::dvec3 zenith{0.0}, horizon{0.0}, ground{0.0};
  std::filesystem::path file;  // empty: none. Radiance HDR or EXR (linear), or whatever else OpenCV reads (sRGB-coded)
  double strength = 1.0;       // factor on the picture
  double turn = 0.0;
};
// But for the file, and `radiance` for one colour instead of three.
template <class V>
void Visit(V& v, SkyDescription& p) {
  if (p.file.empty()) {
    v("zenith", p.zenith, {kOfLight, "sky: radiance from above"});
    v("horizon", p.horizon, {kOfLight, "sky: from the sides"});
    p.ground = p.horizon;
    v("ground", p.ground, {kOfLight, "sky: from below; default: as the horizon"});
  } else {
    v("strength", p.strength, {settings::Range::AtLeast(0), "sky: factor on the picture of its file"});
    double turn_rad = 2 * std::numbers::pi * p.turn;
    v("turn", turn_rad, {settings::Unit::angle, "sky: turns the world to the right"});
    p.turn = turn_rad / (2 * std::numbers::pi);
  }
}

// Throws std::runtime_error naming the file when it cannot be read or has negative or non-finite radiances.
Sky LoadSky(const SkyDescription& description);

}  // namespace sim
