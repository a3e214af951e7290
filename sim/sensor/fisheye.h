// Fisheye projection: the image radius is a polynomial of the angle from the optical axis.
// Source: Kannala and Brandt 2006, as OpenCV (cv::fisheye) and Kalibr ("equidistant") write it; docs/conventions.md.
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

namespace sim {

// r(theta) = theta (1 + k1 theta^2 + k2 theta^4 + k3 theta^6 + k4 theta^8), in units of the focal length.
struct Fisheye {
  std::array<double, 4> k{};

  double Radius(double theta) const;
  double RadiusByTheta(double theta) const;

  // Direction in C, of any length, not along -z -> the point in units of the focal length.
  glm::dvec2 Project(const glm::dvec3& direction) const;

  // The unit direction of a point, to 1e-14; none where the lens is not one-to-one on the way from the axis to it, or
  // where it would lie more than pi from the axis.
  std::optional<glm::dvec3> Unproject(const glm::dvec2& point) const;
};

}  // namespace sim
