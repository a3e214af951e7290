// Lights and shadow maps, in the form that the shaders read. Private to sim/render.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "sim/render/gl_objects.h"
#include "sim/render/raster_scene.h"
#include "sim/world/light.h"

namespace sim {

// Six texels of the shader's table.
struct RasterLight {
  glm::vec4 place;   // towards the sun (unit), or where the light is, in W; w: 0 sun, 1 point, 2 point of a rectangle
  glm::vec4 power;   // as in LightSample; w: its first layer in the shadow maps
  glm::vec4 normal;  // of a rectangle
  glm::vec4 map[3];  // of a sun: (map . (X_W, 1)) is the place in its shadow map, and how near it is; all in 0 ... 1
};

// All lights but the ambient ones, at a time sample of an exposure. point: of rectangles, in parts of their sides.
std::vector<RasterLight> LightsOfSample(const std::vector<Light>& lights, const glm::dvec2& point,
                                        const RasterScene& scene);

// Depth of the lit surfaces: for a point light the six faces of a cube, for a sun one picture of the whole scene. Maps
// of suns and points are drawn once, those of rectangles once for each number of samples, since the world is static.
class ShadowMaps {
 public:
  // side: [texel] of each map; halved as often as it takes for all rectangles' to fit into one GiB.
  ShadowMaps(const GlApi& gl, int side) : gl_(gl), side_(side) {}

  // Draws the maps not drawn yet. lights: of sample 0 ... n - 1. For static worlds.
  void Draw(const RasterScene& scene, const Program& triangles, const std::vector<std::vector<RasterLight>>& lights);
  // Draws all maps of one sample of a moving world, replacing the earlier ones; its rectangles' maps are of_sample(0).
  void DrawSample(const RasterScene& scene, const Program& triangles, const std::vector<RasterLight>& lights);

  GLuint lasting() const { return lasting_.id(); }  // of suns and points
  GLuint of_sample(std::size_t i) const { return samples_.empty() ? lasting_.id() : samples_[i].id(); }  // rectangles

 private:
  GlObject MakeMaps(int layers, int side) const;
  void DrawLight(const RasterScene& scene, const Program& triangles, const RasterLight& light, const GlObject& maps,
                 int side) const;

  const GlApi& gl_;
  int side_;
  GlObject lasting_;
  std::vector<GlObject> samples_;
};

}  // namespace sim
