#include "sim/world/light.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <string>

namespace sim {

double FlickerFactor(const Flicker& flicker, double t_s, double width_s) {
  const double half_angle = std::numbers::pi * flicker.frequency_hz * width_s;
  const double smoothing = half_angle > 0 ? std::sin(half_angle) / half_angle : 1.0;
  const double turns = flicker.frequency_hz * t_s + flicker.phase;
  return 1.0 + flicker.depth * smoothing * std::sin(2 * std::numbers::pi * (turns - std::floor(turns)));
}

std::optional<LightSource> SourceOf(const Light& light, const glm::dvec2& part) {
  using Kind = LightSource::Kind;
  if (const auto* sun = std::get_if<SunLight>(&light))
    return LightSource{Kind::sun, -glm::normalize(sun->direction), sun->irradiance};
  if (const auto* point = std::get_if<PointLight>(&light))
    return LightSource{Kind::point, point->position, point->intensity};
  if (const auto* rect = std::get_if<RectLight>(&light)) {
    return LightSource{Kind::rectangle, rect->corner + part.x * rect->side_u + part.y * rect->side_v, rect->radiance,
                       glm::cross(rect->side_u, rect->side_v)};
  }
  return std::nullopt;
}

Flicker FlickerOf(const Light& light) {
  Flicker flicker;
  if (const auto* point = std::get_if<PointLight>(&light)) flicker = point->flicker;
  if (const auto* rect = std::get_if<RectLight>(&light)) flicker = rect->flicker;
  return flicker.depth > 0 ? flicker : Flicker{};
}

std::vector<Flicker> Flickers(const std::vector<Light>& lights) {
  std::vector<Flicker> flickers{Flicker{}};
  for (const Light& light : lights) {
    const Flicker flicker = FlickerOf(light);
    if (std::find(flickers.begin(), flickers.end(), flicker) == flickers.end()) flickers.push_back(flicker);
  }
  if (flickers.size() > kMaxFlickers) {
    throw std::invalid_argument("world.lights: lamps with " + std::to_string(flickers.size() - 1) +
                                " different flickers; at most " + std::to_string(kMaxFlickers - 1) +
                                " can be kept apart");
  }
  return flickers;
}

int LayerOf(const Light& light, const std::vector<Flicker>& flickers) {
  return static_cast<int>(std::find(flickers.begin(), flickers.end(), FlickerOf(light)) - flickers.begin());
}

}  // namespace sim
