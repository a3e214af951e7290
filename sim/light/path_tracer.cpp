#include "sim/light/path_tracer.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "sim/random/random.h"
#include "sim/render/embree.h"
#include "sim/render/sample_pattern.h"

namespace sim {
namespace {

constexpr double kOffset = 1e-5;  // of the size of the numbers, as in packet.inc
constexpr double kInvPi = std::numbers::inv_pi;

glm::dvec3 Origin(const LightPoint& point) {
  const glm::dvec3 a = glm::abs(point.position);
  return point.position + kOffset * (a.x + a.y + a.z + 1.0) * point.geometric;
}

// Distributed as the cosine with n over its hemisphere: density cos / pi. The basis is that of Duff et al. 2017.
glm::dvec3 CosineDirection(const glm::dvec3& n, double u, double v) {
  const double radius = std::sqrt(u), angle = 2 * std::numbers::pi * v;
  const double sign = std::copysign(1.0, n.z), a = -1.0 / (sign + n.z), b = n.x * n.y * a;
  const glm::dvec3 t(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x), s(b, sign + n.y * n.y * a, -n.y);
  return radius * std::cos(angle) * t + radius * std::sin(angle) * s + std::sqrt(std::max(0.0, 1.0 - u)) * n;
}

double Strength(const glm::dvec3& color) { return color.x + color.y + color.z; }

}  // namespace

// Intersection of a ray.
struct PathTracer::Met {
  std::uint32_t triangle;
  float u, v;
  double distance;
  LightPoint point;  // on the side from which the ray came
};

// Connection from a point to a lamp: `light` is irradiance / pi without occlusion.
struct PathTracer::Reach {
  glm::dvec3 light{0.0};
  glm::dvec3 to{0.0};  // W: the lamp's point, or the direction to the sun
  bool directional = false;
};

PathTracer::PathTracer(const Scene& scene, const RayScene& rays)
    : scene_(scene), rays_(rays), layers_(Flickers(scene.lights)) {
  for (const Light& light : scene.lights) {
    if (!std::holds_alternative<AmbientLight>(light))
      lamps_.push_back({&light, static_cast<std::size_t>(LayerOf(light, layers_))});
  }
}

PathTracer::Reach PathTracer::Towards(const Lamp& lamp, const LightPoint& point, double u, double v) const {
  const LightSource source = *SourceOf(*lamp.light, {u, v});
  Reach reach;
  reach.to = source.place;
  reach.directional = source.kind == LightSource::Kind::sun;
  if (reach.directional) {
    const double cosine = glm::dot(point.normal, reach.to);
    if (cosine > 0 && glm::dot(point.geometric, reach.to) > 0) reach.light = source.power * (cosine * kInvPi);
    return reach;
  }
  double emitted = 1.0;  // of a rectangle: the area times the cosine there
  if (source.kind == LightSource::Kind::rectangle)
    emitted = -glm::dot(source.area, glm::normalize(reach.to - point.position));
  const glm::dvec3 l = reach.to - point.position;
  const double r2 = glm::dot(l, l), cosine = glm::dot(point.normal, l) / std::sqrt(r2);
  if (cosine > 0 && emitted > 0 && r2 > 0 && glm::dot(point.geometric, l) > 0)
    reach.light = source.power * (emitted * cosine / r2 * kInvPi);
  return reach;
}

bool PathTracer::IsFree(const glm::dvec3& origin, const glm::dvec3& direction, float reach) const {
  RTCRay ray = MakeRay(origin, direction, reach);
  Occluded1(rays_.embree(), &ray);
  return ray.tfar >= 0;
}

bool PathTracer::IsSeen(const LightPoint& point, const Reach& reach) const {
  const glm::dvec3 origin = Origin(point);
  return reach.directional ? IsFree(origin, reach.to, std::numeric_limits<float>::infinity())
                           : IsFree(origin, reach.to - origin, 1.0f);
}

bool PathTracer::SeeEachOther(const LightPoint& a, const LightPoint& b) const {
  const glm::dvec3 from = Origin(a), way = Origin(b) - from;
  return way == glm::dvec3(0.0) || IsFree(from, way, 1.0f);
}

bool PathTracer::Trace(const LightPoint& from, const glm::dvec3& direction, Met& met) const {
  const glm::dvec3 origin = Origin(from);
  const RTCRayHit ray = Cast(rays_.embree(), origin, direction);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
  met.triangle = rays_.Triangle(ray.hit.instID[0], ray.hit.geomID, ray.hit.primID);
  met.u = ray.hit.u, met.v = ray.hit.v;
  met.distance = ray.ray.tfar;
  met.point.position = origin + met.distance * direction;
  met.point.geometric = glm::normalize(glm::dvec3(ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z));
  if (glm::dot(met.point.geometric, direction) > 0) met.point.geometric = -met.point.geometric;
  met.point.normal = glm::normalize(glm::dvec3(rays_.ShadingNormal(met.triangle, met.u, met.v)));
  if (glm::dot(met.point.normal, met.point.geometric) < 0) met.point.normal = -met.point.normal;
  return true;
}

// The texel nearest to the intersection, of the level whose texels are as wide as the path: the mean over paths filters
// it.
glm::dvec3 PathTracer::LookUp(int picture, const Met& met, double width) const {
  const Texture& texture = scene_.textures[static_cast<std::size_t>(picture)];
  const double footprint =
      width * rays_.UvPerMetre(met.triangle) * std::sqrt(static_cast<double>(texture.width()) * texture.height());
  const int top = static_cast<int>(texture.levels().size()) - 1;
  const int level = std::clamp(static_cast<int>(std::lround(std::log2(std::max(footprint, 1.0)))), 0, top);
  const TextureLevel& size = texture.levels()[static_cast<std::size_t>(level)];
  glm::vec2 uv = rays_.TextureCoordinates(met.triangle, met.u, met.v);
  uv -= glm::floor(uv);
  const int x = std::min(static_cast<int>(uv.x * static_cast<float>(size.width)), size.width - 1);
  const int y = std::min(static_cast<int>(uv.y * static_cast<float>(size.height)), size.height - 1);
  return texture.Texel(level, x, y);
}

glm::dvec3 PathTracer::Albedo(const Met& met, double width) const {
  const std::size_t index = rays_.MaterialIndex(met.triangle);
  if (index >= scene_.materials.size()) return glm::dvec3(0.0);  // a visible lamp
  const Material& material = scene_.materials[index];
  const glm::dvec3 albedo = glm::dvec3(material.base_color) * glm::dvec3(rays_.VertexColor(met.triangle, met.u, met.v));
  return material.texture < 0 ? albedo : albedo * LookUp(material.texture, met, width);
}

glm::dvec3 PathTracer::Emission(const Met& met, double width) const {
  const std::size_t index = rays_.MaterialIndex(met.triangle);
  if (index >= scene_.materials.size()) return glm::dvec3(0.0);  // a visible lamp: already counted as a lamp
  const Material& material = scene_.materials[index];
  const glm::dvec3 emission(material.emission);
  const bool has_picture = material.emission_texture >= 0 && Strength(emission) > 0;
  return has_picture ? emission * LookUp(material.emission_texture, met, width) : emission;
}

void PathTracer::AddDirect(const LightPoint& point, std::uint64_t key, int samples, std::span<glm::dvec3> sums) const {
  for (std::size_t k = 0; k < lamps_.size(); ++k) {
    const bool is_area = std::holds_alternative<RectLight>(*lamps_[k].light);
    const int count = is_area ? samples : 1;
    const Words bits = RandomWords(key, Stream::light_path, 0, 0xffffffffu, static_cast<std::uint32_t>(k));
    glm::dvec3 sum(0.0);
    for (int i = 0; i < count; ++i) {
      const PatternPoint at = SobolPoint(static_cast<std::uint32_t>(i));
      const Reach reach = Towards(lamps_[k], point, ToUnit(at.u ^ bits[0]), ToUnit(at.v ^ bits[1]));
      if (Strength(reach.light) > 0 && IsSeen(point, reach)) sum += reach.light;
    }
    sums[lamps_[k].layer] += sum / static_cast<double>(count);
  }
}

void PathTracer::AddIndirect(const LightPoint& point, std::uint64_t key, int paths, std::span<glm::dvec3> sums) const {
  const Words shift = RandomWords(key, Stream::light_path, 0, 0xfffffffeu, 0);
  const double share = 1.0 / paths, angle = std::sqrt(2.0 * std::numbers::pi * share);
  std::vector<double> strengths(lamps_.size());
  std::vector<Reach> reaches(lamps_.size());
  for (int path = 0; path < paths; ++path) {
    const auto number = static_cast<std::uint32_t>(path);
    const PatternPoint first = SobolPoint(number);
    LightPoint at = point;
    glm::dvec3 direction = CosineDirection(at.normal, ToUnit(first.u ^ shift[0]), ToUnit(first.v ^ shift[1]));
    glm::dvec3 factor(share);
    double length = 0;
    for (std::uint32_t bounce = 0;; ++bounce) {
      Met met;
      if (!Trace(at, direction, met)) {
        sums[0] += factor * (scene_.sky ? scene_.sky->Radiance(direction) : glm::dvec3(scene_.background));
        break;
      }
      length += met.distance;
      sums[0] += factor * Emission(met, angle * length);
      factor *= Albedo(met, angle * length);
      const double survival = std::min(0.95, std::max({factor.x, factor.y, factor.z}) / share);
      if (!(survival > 0)) break;
      at = met.point;

      const Words lamp_words = RandomWords(key, Stream::light_path, number, bounce, 0);
      double total = 0;
      for (std::size_t k = 0; k < lamps_.size(); ++k) {
        reaches[k] = Towards(lamps_[k], at, Uniform(lamp_words[0]), Uniform(lamp_words[1]));
        total += strengths[k] = Strength(reaches[k].light);
      }
      if (total > 0) {  // one lamp, with probability proportional to its unoccluded irradiance
        std::size_t k = 0;
        for (double left = Uniform(lamp_words[2]) * total; k + 1 < lamps_.size() && left >= strengths[k]; ++k)
          left -= strengths[k];
        if (strengths[k] > 0 && IsSeen(at, reaches[k]))
          sums[lamps_[k].layer] += factor * reaches[k].light * (total / strengths[k]);
      }

      if (Uniform(lamp_words[3]) >= survival) break;
      factor /= survival;
      const Words words = RandomWords(key, Stream::light_path, number, bounce, 1);
      direction = CosineDirection(at.normal, Uniform(words[0]), Uniform(words[1]));
    }
  }
}

}  // namespace sim
