#include "sim/render/scene_surroundings.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>

#include "sim/render/ray_scene.h"

namespace sim {
namespace {

// Of a triangle. Source: Ericson 2005, "Real-time collision detection", section 5.1.5.
glm::dvec3 ClosestPoint(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 ab = b - a, ac = c - a;
  const double d1 = glm::dot(ab, p - a), d2 = glm::dot(ac, p - a);
  if (d1 <= 0 && d2 <= 0) return a;
  const double d3 = glm::dot(ab, p - b), d4 = glm::dot(ac, p - b);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
  const double d5 = glm::dot(ab, p - c), d6 = glm::dot(ac, p - c);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  return a + (vb * ab + vc * ac) / (va + vb + vc);
}

struct Query {
  const RayScene& rays;
  glm::dvec3 p, nearest{0.0};
  double distance;
  bool found = false;
};

// Called by Embree for each triangle that may be nearer.
bool Consider(RTCPointQueryFunctionArguments* arguments) {
  auto& query = *static_cast<Query*>(arguments->userPtr);
  const std::uint32_t t = query.rays.Triangle(RTC_INVALID_GEOMETRY_ID, arguments->geomID, arguments->primID);
  const glm::dvec3 point = ClosestPoint(query.p, glm::dvec3(query.rays.Corner(t, 0)),
                                        glm::dvec3(query.rays.Corner(t, 1)), glm::dvec3(query.rays.Corner(t, 2)));
  const double distance = glm::distance(query.p, point);
  if (!(distance < query.distance)) return false;
  query.distance = distance;
  query.nearest = point;
  query.found = true;
  arguments->query->radius = std::nextafter(static_cast<float>(distance), std::numeric_limits<float>::infinity());
  return true;
}

class SceneSurroundings : public Surroundings {
 public:
  SceneSurroundings(const Scene& scene, const RayScene& rays) : scene_(scene), rays_(rays) {
    rtcGetSceneBounds(rays.embree(), &box_);
  }

  glm::dvec3 low() const override { return {box_.lower_x, box_.lower_y, box_.lower_z}; }
  glm::dvec3 high() const override { return {box_.upper_x, box_.upper_y, box_.upper_z}; }

  std::optional<glm::dvec3> Nearest(const glm::dvec3& p, double radius) const override {
    Query query{.rays = rays_, .p = p, .distance = radius};
    RTCPointQuery sphere{};
    sphere.x = static_cast<float>(p.x), sphere.y = static_cast<float>(p.y), sphere.z = static_cast<float>(p.z);
    // Embree's own sphere is about the rounded point.
    sphere.radius = static_cast<float>(radius + 1e-6 * (radius + glm::length(p)));
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(rays_.embree(), &sphere, &context, Consider, &query);
    if (!query.found) return std::nullopt;
    return query.nearest;
  }

  std::optional<Hit> Between(const glm::dvec3& a, const glm::dvec3& b) const override {
    constexpr std::uint32_t kSolid = 0;  // the geometry of opaque surfaces
    constexpr double kPast = 1e-5;
    for (double from = 0; from <= 1;) {
      const RTCRayHit ray = Cast(rays_.embree(), a, b - a, 1, static_cast<float>(from));
      if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
      const double at = ray.ray.tfar;
      if (ray.hit.geomID == kSolid) {
        const std::uint32_t triangle = rays_.Triangle(RTC_INVALID_GEOMETRY_ID, kSolid, ray.hit.primID);
        return Hit{a + at * (b - a), scene_.meshes[rays_.MeshOf(triangle)].name};
      }
      from = at + kPast;
    }
    return std::nullopt;
  }

  double Luminance(std::uint32_t triangle, float u, float v) const {
    const auto index = static_cast<std::size_t>(rays_.MaterialIndex(triangle));
    if (index >= scene_.materials.size()) return 1;  // a lamp
    const Material& material = scene_.materials[index];
    glm::vec3 color = material.base_color * rays_.VertexColor(triangle, u, v);
    if (material.texture >= 0) {
      const Texture& texture = scene_.textures[static_cast<std::size_t>(material.texture)];
      const glm::vec2 uv = glm::fract(rays_.TextureCoordinates(triangle, u, v));
      const auto texel = [](float x, int size) {
        return std::min(static_cast<int>(x * static_cast<float>(size)), size - 1);
      };
      color *= texture.Texel(0, texel(uv.x, texture.width()), texel(uv.y, texture.height()));
    }
    return glm::dot(color, glm::vec3(0.2126f, 0.7152f, 0.0722f));
  }

  double Interest(const Pose& view) const override {
    constexpr int kSide = 5;
    constexpr double kDark = 0.1;        // differences between darker albedos are ignored
    double seen[kSide][kSide], sum = 0;  // logarithm; NaN: nothing
    for (int j = 0; j < kSide; ++j) {
      for (int i = 0; i < kSide; ++i) {
        const glm::dvec3 way(0.2885 * (i - 2), 0.202 * (j - 2), 1);  // to tan 30 and tan 22 degrees
        const RTCRayHit ray = Cast(rays_.embree(), view.p_WC, view.q_WC * way);
        const bool met = ray.hit.geomID != RTC_INVALID_GEOMETRY_ID;
        const std::uint32_t triangle =
            met ? rays_.Triangle(RTC_INVALID_GEOMETRY_ID, ray.hit.geomID, ray.hit.primID) : 0;
        seen[j][i] = met ? std::log(kDark + Luminance(triangle, ray.hit.u, ray.hit.v)) : std::nan("");
        for (const double other : {i > 0 ? seen[j][i - 1] : std::nan(""), j > 0 ? seen[j - 1][i] : std::nan("")})
          if (met && std::isfinite(other)) sum += std::abs(seen[j][i] - other);
      }
    }
    return sum / (2 * kSide * (kSide - 1));
  }

 private:
  const Scene& scene_;
  const RayScene& rays_;
  RTCBounds box_;
};

}  // namespace

std::unique_ptr<Surroundings> SurroundingsOf(const Scene& scene, const RayScene& rays) {
  return std::make_unique<SceneSurroundings>(scene, rays);
}

}  // namespace sim
