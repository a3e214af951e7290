// Purpose: the ray of a pixel's centre where the table's accuracy is not enough: truth, and what is seen at an edge.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "sim/sensor/camera.h"

namespace sim {

// In C, in the length of Camera::Ray: the camera's table, then one Newton step on Project, which takes its 0.003 px to
// 1e-6 px.
inline glm::dvec3 ExactRay(const Camera& camera, int x, int y) {
  const auto u = static_cast<float>(x), v = static_cast<float>(y);
  const glm::dvec3 ray(camera.Ray(u, v));
  const glm::dvec3 du(camera.Ray(u + 0.5f, v) - camera.Ray(u - 0.5f, v)),
      dv(camera.Ray(u, v + 0.5f) - camera.Ray(u, v - 0.5f));
  const glm::dvec2 miss = glm::dvec2(x, y) - camera.Project(ray);
  return ray + miss.x * du + miss.y * dv;
}

}  // namespace sim
