// Surroundings of a path: nearest surface, first surface between two points, and visual interest of a view.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <string>

#include "sim/motion/pose.h"

namespace sim {

// Static surfaces only, without moving objects. Concurrent calls are allowed.
class Surroundings {
 public:
  virtual ~Surroundings() = default;

  // The nearest surface point within `radius` of p, in W [m].
  virtual std::optional<glm::dvec3> Nearest(const glm::dvec3& p, double radius) const = 0;

  struct Hit {
    glm::dvec3 point{0.0};  // in W
    std::string mesh;
  };
  // The first solid surface on the straight way from a to b. Cut-outs (leaves, grids) and lamps are not solid.
  virtual std::optional<Hit> Between(const glm::dvec3& a, const glm::dvec3& b) const = 0;

  // Mean difference of the logarithm of albedo between neighbouring ones of 5 x 5 directions within +-30 x +-22 degrees
  // of the camera's axis: 0 where nothing is, or nothing differs.
  virtual double Interest(const Pose& view) const = 0;

  // A box around everything.
  virtual glm::dvec3 low() const = 0;
  virtual glm::dvec3 high() const = 0;
};

}  // namespace sim
