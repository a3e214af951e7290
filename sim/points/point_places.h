// Positions of the landmarks of a point world, where they are not drawn from a prior.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "sim/motion/pose.h"
#include "sim/scenario/point_description.h"

namespace sim {

// Uniform on the six faces of the box, on the square, or in the box; `start` is the first camera. Point k is a function
// of (key, k) alone, so that more points leave the first ones where they are. None for Landmarks::prior.
std::vector<glm::dvec3> PlacePoints(const PointDescription& points, const Pose& start, std::uint64_t key);

}  // namespace sim
