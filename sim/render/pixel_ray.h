// Ray through the centre of a pixel to 1e-6 px, for truth: the lookup table of Camera::Ray is less accurate.
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "sim/sensor/camera.h"

namespace sim {

// In C, of any length: the camera's table, then one Newton step on Project, which takes the table's 0.003 px to 1e-6
// px. In small pictures, whose pixels are wide and bent, it may not: then the lens itself is inverted.
inline glm::dvec3 ExactRay(const Camera& camera, int x, int y) {
  constexpr double kExact_px = 1e-6;
  const auto u = static_cast<float>(x), v = static_cast<float>(y);
  const glm::dvec2 pixel(x, y);
  const glm::dvec3 ray(camera.Ray(u, v));
  const glm::dvec3 du(camera.Ray(u + 0.5f, v) - camera.Ray(u - 0.5f, v)),
      dv(camera.Ray(u, v + 0.5f) - camera.Ray(u, v - 0.5f));
  const glm::dvec2 miss = pixel - camera.Project(ray);
  const glm::dvec3 better = ray + miss.x * du + miss.y * dv;
  return glm::distance(camera.Project(better), pixel) < kExact_px ? better : camera.Direction(pixel);
}

}  // namespace sim
