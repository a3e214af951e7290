#include "sim/render/raster_light.h"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "sim/render/raster_draw.h"
#include "sim/render/raster_view.h"

namespace sim {
namespace {

enum Kind { kSun, kPoint, kRectangle };

Kind KindOf(const RasterLight& light) { return static_cast<Kind>(static_cast<int>(light.place.w)); }

// Two right angles to d, of length 1.
std::array<glm::dvec3, 2> Across(const glm::dvec3& d) {
  const glm::dvec3 aside = std::abs(d.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 u = glm::normalize(glm::cross(d, aside));
  return {u, glm::cross(d, u)};
}

// (v . (X, 1)) runs from 0 to 1 over the scene's box and a hundredth of it around, in the direction of `axis`.
glm::vec4 OverBox(const glm::dvec3& axis, const RasterScene& scene) {
  double low = 1e300, high = -1e300;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 at(corner & 1 ? scene.high().x : scene.low().x, corner & 2 ? scene.high().y : scene.low().y,
                        corner & 4 ? scene.high().z : scene.low().z);
    low = std::min(low, glm::dot(axis, at));
    high = std::max(high, glm::dot(axis, at));
  }
  const double around = 0.01 * (high - low) + 1e-6, scale = 1 / (high - low + 2 * around);
  return glm::vec4(glm::dvec4(axis * scale, (around - low) * scale));
}

struct AddLight {
  const glm::dvec2& point;
  const RasterScene& scene;
  std::vector<RasterLight>& out;
  int& lasting_layers;
  int& sample_layers;

  void operator()(const AmbientLight&) const {}
  void operator()(const SunLight& light) const {
    const glm::dvec3 towards = -glm::normalize(light.direction);
    RasterLight& l = Add(towards, light.irradiance, kSun);
    const auto [u, v] = Across(towards);
    l.map[0] = OverBox(u, scene), l.map[1] = OverBox(v, scene), l.map[2] = OverBox(towards, scene);
  }
  void operator()(const PointLight& light) const { Add(light.position, light.intensity, kPoint); }
  void operator()(const RectLight& light) const {
    const glm::dvec3 cross = glm::cross(light.side_u, light.side_v);
    const glm::dvec3 at = light.corner + point.x * light.side_u + point.y * light.side_v;
    Add(at, light.radiance * glm::length(cross), kRectangle).normal = glm::vec4(glm::dvec4(glm::normalize(cross), 0.0));
  }
  RasterLight& Add(const glm::dvec3& place, const glm::dvec3& power, Kind kind) const {
    int& layers = kind == kRectangle ? sample_layers : lasting_layers;
    RasterLight l{};
    l.place = glm::vec4(glm::dvec4(place, static_cast<double>(kind)));
    l.power = glm::vec4(glm::dvec4(power, static_cast<double>(layers)));
    layers += kind == kSun ? 1 : kFaceCount;
    out.push_back(l);
    return out.back();
  }
};

int Layers(const std::vector<RasterLight>& lights, bool of_rectangles) {
  int layers = 0;
  for (const RasterLight& light : lights) {
    const Kind kind = KindOf(light);
    if ((kind == kRectangle) == of_rectangles) layers += kind == kSun ? 1 : kFaceCount;
  }
  return layers;
}

}  // namespace

std::vector<RasterLight> LightsOfSample(const std::vector<Light>& lights, const glm::dvec2& point,
                                        const RasterScene& scene) {
  std::vector<RasterLight> out;
  int lasting_layers = 0, sample_layers = 0;
  for (const Light& light : lights) std::visit(AddLight{point, scene, out, lasting_layers, sample_layers}, light);
  return out;
}

GlObject ShadowMaps::MakeMaps(int layers, int side) const {
  GLuint id = 0;
  gl_.CreateTextures(GL_TEXTURE_2D_ARRAY, 1, &id);
  GlObject maps(gl_, id, [](const GlApi& api, GLuint t) { api.DeleteTextures(1, &t); });
  gl_.TextureStorage3D(id, 1, GL_DEPTH_COMPONENT32F, side, side, std::max(layers, 1));
  gl_.TextureParameteri(id, GL_TEXTURE_MIN_FILTER, GL_LINEAR);  // the mean of four comparisons
  gl_.TextureParameteri(id, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl_.TextureParameteri(id, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl_.TextureParameteri(id, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  gl_.TextureParameteri(id, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  gl_.TextureParameteri(id, GL_TEXTURE_COMPARE_FUNC, GL_GEQUAL);  // greater is nearer
  return maps;
}

void ShadowMaps::Draw(const RasterScene& scene, const Program& triangles,
                      const std::vector<std::vector<RasterLight>>& lights) {
  if (!lasting_) {
    lasting_ = MakeMaps(Layers(lights[0], false), side_);
    for (const RasterLight& light : lights[0]) {
      if (KindOf(light) != kRectangle) DrawLight(scene, triangles, light, lasting_, side_);
    }
  }
  const int layers = Layers(lights[0], true);
  if (layers == 0 || samples_.size() == lights.size()) return;
  samples_.clear();
  int side = side_;
  const auto bytes = [&] { return 4.0 * side * side * layers * static_cast<double>(lights.size()); };
  while (side > 64 && bytes() > 1073741824.0) side /= 2;
  for (const std::vector<RasterLight>& of_sample : lights) {
    samples_.push_back(MakeMaps(layers, side));
    for (const RasterLight& light : of_sample) {
      if (KindOf(light) == kRectangle) DrawLight(scene, triangles, light, samples_.back(), side);
    }
  }
}

void ShadowMaps::DrawSample(const RasterScene& scene, const Program& triangles,
                            const std::vector<RasterLight>& lights) {
  if (!lasting_) lasting_ = MakeMaps(Layers(lights, false), side_);
  if (samples_.empty()) samples_.push_back(MakeMaps(Layers(lights, true), side_));
  for (const RasterLight& light : lights) {
    DrawLight(scene, triangles, light, KindOf(light) == kRectangle ? samples_[0] : lasting_, side_);
  }
}

void ShadowMaps::DrawLight(const RasterScene& scene, const Program& triangles, const RasterLight& light,
                           const GlObject& maps, int side) const {
  const int first = static_cast<int>(light.power.w);
  if (KindOf(light) == kSun) {
    glm::mat4 clip(0.0f);  // by rows
    clip[0] = 2.0f * light.map[0] - glm::vec4(0, 0, 0, 1);
    clip[1] = 2.0f * light.map[1] - glm::vec4(0, 0, 0, 1);
    clip[2] = light.map[2];
    clip[3] = glm::vec4(0, 0, 0, 1);
    DrawDepth(gl_, scene, triangles, glm::vec3(0.0f), glm::transpose(clip), maps, first, side);
    return;
  }
  // As the shader has it: no comparison lacks a neighbour.
  const float border = 1.0f + 16.0f / static_cast<float>(side);
  for (int face = 0; face < kFaceCount; ++face) {
    const glm::mat4 clip = ClipFromView(glm::vec2(-border), glm::vec2(border)) * glm::mat4(FaceFromCamera(face));
    DrawDepth(gl_, scene, triangles, glm::vec3(light.place), clip, maps, first + face, side);
  }
}

}  // namespace sim
