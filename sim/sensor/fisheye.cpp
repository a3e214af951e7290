#include "sim/sensor/fisheye.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace sim {

double Fisheye::Radius(double theta) const {
  const double t2 = theta * theta;
  return theta * (1 + t2 * (k[0] + t2 * (k[1] + t2 * (k[2] + t2 * k[3]))));
}

double Fisheye::RadiusByTheta(double theta) const {
  const double t2 = theta * theta;
  return 1 + t2 * (3 * k[0] + t2 * (5 * k[1] + t2 * (7 * k[2] + t2 * 9 * k[3])));
}

glm::dvec2 Fisheye::Project(const glm::dvec3& direction) const {
  const double off_axis = std::hypot(direction.x, direction.y);
  if (off_axis == 0) return glm::dvec2(0.0);
  return Radius(std::atan2(off_axis, direction.z)) / off_axis * glm::dvec2(direction);
}

std::optional<glm::dvec3> Fisheye::Unproject(const glm::dvec2& point) const {
  const double radius = glm::length(point);
  if (radius == 0) return glm::dvec3(0.0, 0.0, 1.0);
  // March to the first angle that is too large, then halve and refine: a fold on the way is seen.
  constexpr int kSteps = 256;
  double below = 0, above = 0;
  for (int i = 1; i <= kSteps && above == 0; ++i) {
    const double theta = std::numbers::pi * i / kSteps;
    if (!(RadiusByTheta(theta - 0.5 * std::numbers::pi / kSteps) > 1e-6)) return std::nullopt;
    (Radius(theta) >= radius ? above : below) = theta;
  }
  if (above == 0 || !(RadiusByTheta(above) > 1e-6)) return std::nullopt;
  double theta = 0.5 * (below + above);
  for (int i = 0; i < 60; ++i) {
    const double miss = Radius(theta) - radius;
    (miss > 0 ? above : below) = theta;
    const double newton = theta - miss / RadiusByTheta(theta);
    const double next = newton > below && newton < above ? newton : 0.5 * (below + above);
    if (std::abs(next - theta) < 1e-15) break;
    theta = next;
  }
  return glm::dvec3(std::sin(theta) / radius * point, std::cos(theta));
}

}  // namespace sim
