#include "sim/points/point_places.h"

#include "sim/random/random.h"

namespace sim {
namespace {

// On the six faces, all of the same area, of a cube of side 1 about the origin.
glm::dvec3 OnACube(const Words& words, glm::dvec3 in) {
  const int axis = static_cast<int>(words[3] % 3);
  in[axis] = in[axis] < 0 ? -0.5 : 0.5;
  return in;
}

}  // namespace

std::vector<glm::dvec3> PlacePoints(const PointDescription& of, const Pose& start, std::uint64_t key) {
  std::vector<glm::dvec3> points;
  if (of.landmarks == Landmarks::prior) return points;
  const glm::dvec3 center = of.center.value_or(start.p_WC);
  for (int k = 0; k < of.total; ++k) {
    const Words words = RandomWords(key, Stream::point_place, 0, static_cast<std::uint32_t>(k), 0);
    const glm::dvec3 in(Uniform(words[0]) - 0.5, Uniform(words[1]) - 0.5, Uniform(words[2]) - 0.5);
    if (of.landmarks == Landmarks::room) {
      points.push_back(center + of.size_m * OnACube(words, in));
    } else if (of.landmarks == Landmarks::cloud) {
      points.push_back(center + of.size_m * in);
    } else {
      points.push_back(start.p_WC + start.q_WC * glm::dvec3(of.size_m * in.x, of.size_m * in.y, of.distance_m));
    }
  }
  return points;
}

}  // namespace sim
