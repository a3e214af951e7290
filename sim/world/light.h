// Light sources. Radiance, irradiance and intensity are linear RGB in one arbitrary but common unit: a white Lambertian
// surface (albedo 1) under irradiance pi has radiance 1, and radiance 1 is what the sensor calls white at unit
// exposure. Directions and positions are in W.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <numbers>
#include <optional>
#include <variant>
#include <vector>

#include "tools/base/settings/fields.h"

namespace sim {

constexpr settings::Range kOfLight{0, 1e6};      // a colour
constexpr settings::Range kOfPlaces{-1e6, 1e6};  // coordinates

// A lamp on alternating current: its power is multiplied by 1 + depth * sin(2 pi (frequency t + phase)), of mean 1.
struct Flicker {
  double frequency_hz = 0.0;  // of the light: twice that of the current
  double depth = 0.0;         // 0: steady, 1: goes dark
  double phase = 0.0;         // in turns, at t = 0
  bool operator==(const Flicker&) const = default;
};
template <class V>
void Visit(V& v, Flicker& p) {
  using settings::Unit;
  v("frequency", p.frequency_hz, {Unit::frequency, settings::Range::AtLeast(0), "above 0 where the lamp flickers"});
  v("depth", p.depth, {settings::Range{0, 1}, "0: steady, 1: goes dark"});
  double phase_rad = 2 * std::numbers::pi * p.phase;
  v("phase", phase_rad, {Unit::angle, "at t = 0"});
  p.phase = phase_rad / (2 * std::numbers::pi);
}
// The factor averaged over t - width / 2 ... t + width / 2; at one instant where width is 0.
double FlickerFactor(const Flicker& flicker, double t_s, double width_s = 0.0);

// The same radiance from everywhere, never occluded: adds albedo * radiance to every surface. An approximation of
// indirect light; omitted where that is computed (baked light).
struct AmbientLight {
  glm::dvec3 radiance{1.0};
};
template <class V>
void Visit(V& v, AmbientLight& p) {
  v("radiance", p.radiance, {kOfLight, "ambient, rectangle, sky"});
}

// Infinitely far: hard shadows. A surface whose normal makes the angle a with the light gets irradiance * cos(a).
struct SunLight {
  glm::dvec3 direction{0.0, -1.0, 0.0};  // in which the light travels; any length but zero
  glm::dvec3 irradiance{1.0};            // on a surface that faces the sun
};
template <class V>
void Visit(V& v, SunLight& p) {
  v("direction", p.direction, {kOfPlaces, "sun: in which the light travels; any length but zero"});
  v("irradiance", p.irradiance, {kOfLight, "sun: on a surface that faces it"});
}

// Irradiance = intensity * cos(a) / distance^2: hard shadows.
struct PointLight {
  glm::dvec3 position{0.0};
  glm::dvec3 intensity{1.0};
  Flicker flicker{};
};
template <class V>
void Visit(V& v, PointLight& p) {
  v("position", p.position, {settings::Unit::length, kOfPlaces, "point: in W"});
  v("intensity", p.intensity, {kOfLight, "point: irradiance times squared distance"});
  v.Child("flicker", p.flicker);
}

// A parallelogram with corner `corner` and sides `side_u`, `side_v` that shines on the side of cross(side_u, side_v),
// with the same radiance in all directions: soft shadows. Sample i of n of an exposure uses the i-th point of a fixed
// n-point pattern on the light, the same for all pixels and frames: no noise, but at n = 1 a hard shadow. Where it is
// `visible`, it is seen from the side on which it shines, as a surface of that radiance; it never casts a shadow.
struct RectLight {
  glm::dvec3 corner{0.0};
  glm::dvec3 side_u{1.0, 0.0, 0.0};
  glm::dvec3 side_v{0.0, 0.0, 1.0};
  glm::dvec3 radiance{1.0};
  Flicker flicker{};
  bool visible = false;
};
template <class V>
void Visit(V& v, RectLight& p) {
  v("corner", p.corner, {settings::Unit::length, kOfPlaces, "rectangle: in W"});
  v("side_u", p.side_u, {settings::Unit::length, kOfPlaces, "rectangle: from the corner"});
  v("side_v", p.side_v, {settings::Unit::length, kOfPlaces, "rectangle: shines towards u x v"});
  v("radiance", p.radiance, {kOfLight, "rectangle: the same in all directions"});
  v.Child("flicker", p.flicker);
  v("visible", p.visible, {"rectangle: seen as a surface of its radiance"});
}

using Light = std::variant<AmbientLight, SunLight, PointLight, RectLight>;

// A light as seen from the lit surface: one of its points.
struct LightSource {
  enum class Kind { sun, point, rectangle } kind;
  glm::dvec3 place;      // towards a sun (unit), or where it is, in W
  glm::dvec3 power;      // irradiance, intensity, or of a rectangle the radiance
  glm::dvec3 area{0.0};  // of a rectangle: cross(side_u, side_v)
};
// part: in parts of a rectangle's sides. None for ambient light.
std::optional<LightSource> SourceOf(const Light& light, const glm::dvec2& part);

// The flicker of a lamp; steady for other lights, and for lamps of depth 0.
Flicker FlickerOf(const Light& light);
// Distinct flickers of the lights: steady first, then in their order. Throws std::invalid_argument for more than 8: a
// renderer keeps the light of each apart, in layers.
constexpr std::size_t kMaxFlickers = 8;
std::vector<Flicker> Flickers(const std::vector<Light>& lights);
int LayerOf(const Light& light, const std::vector<Flicker>& flickers);

}  // namespace sim
