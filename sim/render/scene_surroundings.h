// Surroundings of a path, by distance and ray queries of the ray tracer's scene.
#pragma once

#include "sim/motion/surroundings.h"
#include "sim/render/surface_tracer.h"
#include "sim/world/scene.h"

namespace sim {

class SceneSurroundings : public Surroundings {
 public:
  // Both must outlive it; the tracer is of this scene.
  SceneSurroundings(const Scene& scene, const SurfaceTracer& surfaces);

  std::optional<glm::dvec3> Nearest(const glm::dvec3& p, double radius) const override;
  std::optional<Hit> Between(const glm::dvec3& a, const glm::dvec3& b) const override;
  double Interest(const Pose& view) const override;
  glm::dvec3 low() const override { return low_; }
  glm::dvec3 high() const override { return high_; }

 private:
  double Luminance(std::uint32_t triangle, float u, float v) const;

  const Scene& scene_;
  const RayScene& rays_;
  glm::dvec3 low_{0.0}, high_{0.0};
};

}  // namespace sim
