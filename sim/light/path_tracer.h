// Path tracer for the irradiance at a point of a surface. Private to sim/light.
// Source: Kajiya 1986, "The rendering equation"; next-event estimation and Russian roulette as in Pharr, Jakob and
//   Humphreys, "Physically based rendering", chapter 14. Points: sim/render/sample_pattern.h.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "sim/render/ray_scene.h"
#include "sim/world/scene.h"

namespace sim {

// One side of a surface, in W.
struct LightPoint {
  glm::dvec3 position;
  glm::dvec3 normal;     // unit: that of shading,
  glm::dvec3 geometric;  // and that of the triangle, on the same side
};

// All results are irradiance / pi: the radiance of a white Lambert surface. Lamps are the sun, points and rectangles;
// light of lamps with different flicker is kept in separate layers (0: steady). Surfaces are Lambertian, with textures
// filtered over the width of a path and without normal maps. The estimates are unbiased, functions of their arguments
// alone.
class PathTracer {
 public:
  // Keeps references to both; uses the scene's materials, textures, lights and sky. Throws std::invalid_argument for
  // more than kMaxFlickers different flickers.
  PathTracer(const Scene& scene, const RayScene& rays);

  const std::vector<Flicker>& layers() const { return layers_; }

  // Adds indirect light: from the sky, from emitting surfaces and from lit surfaces, but not directly from lamps. Mean
  // over `paths` paths, a power of two. sums: by layer.
  void AddIndirect(const LightPoint& point, std::uint64_t key, int paths, std::span<glm::dvec3> sums) const;

  // Adds direct light of the lamps; a rectangle is sampled at `samples` points, a power of two.
  void AddDirect(const LightPoint& point, std::uint64_t key, int samples, std::span<glm::dvec3> sums) const;

  // Whether no surface is between two points (a little above their surfaces).
  bool SeeEachOther(const LightPoint& a, const LightPoint& b) const;

 private:
  struct Lamp {
    const Light* light;
    std::size_t layer;
  };
  struct Met;
  struct Reach;

  Reach Towards(const Lamp& lamp, const LightPoint& point, double u, double v) const;
  bool IsSeen(const LightPoint& point, const Reach& reach) const;
  bool IsFree(const glm::dvec3& origin, const glm::dvec3& direction, float reach) const;
  bool Trace(const LightPoint& from, const glm::dvec3& direction, Met& met) const;
  glm::dvec3 LookUp(int picture, const Met& met, double width) const;
  glm::dvec3 Albedo(const Met& met, double width) const;
  glm::dvec3 Emission(const Met& met, double width) const;

  const Scene& scene_;
  const RayScene& rays_;
  std::vector<Flicker> layers_;
  std::vector<Lamp> lamps_;
};

}  // namespace sim
