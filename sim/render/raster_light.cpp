#include "sim/render/raster_light.h"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "sim/render/raster_view.h"

namespace sim {
namespace {

using Kind = LightSource::Kind;

Kind KindOf(const RasterLight& light) { return static_cast<Kind>(static_cast<int>(light.place.w)); }

int LayersOf(Kind kind) { return kind == Kind::sun ? 1 : kFaceCount; }

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

int Layers(const std::vector<RasterLight>& lights, bool of_rectangles) {
  int layers = 0;
  for (const RasterLight& light : lights) {
    if ((KindOf(light) == Kind::rectangle) == of_rectangles) layers += LayersOf(KindOf(light));
  }
  return layers;
}

}  // namespace

std::vector<RasterLight> LightsOfSample(const std::vector<Light>& lights, const glm::dvec2& point,
                                        const RasterScene& scene) {
  std::vector<RasterLight> out;
  for (const Light& light : lights) {
    const std::optional<LightSource> source = SourceOf(light, point);
    if (!source) continue;
    const bool is_rectangle = source->kind == Kind::rectangle;
    RasterLight l{};
    l.place = glm::vec4(glm::dvec4(source->place, static_cast<double>(source->kind)));
    const glm::dvec3 power = is_rectangle ? source->power * glm::length(source->area) : source->power;
    l.power = glm::vec4(glm::dvec4(power, static_cast<double>(Layers(out, is_rectangle))));
    if (is_rectangle) l.normal = glm::vec4(glm::dvec4(glm::normalize(source->area), 0.0));
    if (source->kind == Kind::sun) {
      const auto [u, v] = Across(source->place);
      l.map[0] = OverBox(u, scene), l.map[1] = OverBox(v, scene), l.map[2] = OverBox(source->place, scene);
    }
    out.push_back(l);
  }
  return out;
}

GlObject ShadowMaps::MakeMaps(int layers, int side) const {
  GlObject maps = NewTexture(gl_, GL_TEXTURE_2D_ARRAY);
  const GLuint id = maps.id();
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
      if (KindOf(light) != Kind::rectangle) DrawLight(scene, triangles, light, lasting_, side_);
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
      if (KindOf(light) == Kind::rectangle) DrawLight(scene, triangles, light, samples_.back(), side);
    }
  }
}

void ShadowMaps::DrawSample(const RasterScene& scene, const Program& triangles,
                            const std::vector<RasterLight>& lights) {
  if (!lasting_) lasting_ = MakeMaps(Layers(lights, false), side_);
  if (samples_.empty()) samples_.push_back(MakeMaps(Layers(lights, true), side_));
  for (const RasterLight& light : lights) {
    DrawLight(scene, triangles, light, KindOf(light) == Kind::rectangle ? samples_[0] : lasting_, side_);
  }
}

void ShadowMaps::DrawLight(const RasterScene& scene, const Program& triangles, const RasterLight& light,
                           const GlObject& maps, int side) const {
  const auto draw = [&](int layer, const glm::vec3& origin, const glm::mat4& clip) {
    const GlObject target = MakeFramebuffer(gl_);
    gl_.NamedFramebufferTextureLayer(target.id(), GL_DEPTH_ATTACHMENT, maps.id(), 0, layer);
    gl_.NamedFramebufferDrawBuffer(target.id(), GL_NONE);
    scene.Draw(triangles, target, glm::ivec2(side), origin, clip);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, 0);
  };
  const int first = static_cast<int>(light.power.w);
  if (KindOf(light) == Kind::sun) {
    glm::mat4 clip(0.0f);  // by rows
    clip[0] = 2.0f * light.map[0] - glm::vec4(0, 0, 0, 1);
    clip[1] = 2.0f * light.map[1] - glm::vec4(0, 0, 0, 1);
    clip[2] = light.map[2];
    clip[3] = glm::vec4(0, 0, 0, 1);
    draw(first, glm::vec3(0.0f), glm::transpose(clip));
    return;
  }
  // As the shader has it: no comparison lacks a neighbour.
  const float border = 1.0f + 16.0f / static_cast<float>(side);
  for (int face = 0; face < kFaceCount; ++face) {
    const glm::mat4 clip = ClipFromView(glm::vec2(-border), glm::vec2(border)) * glm::mat4(FaceFromCamera(face));
    draw(first + face, glm::vec3(light.place), clip);
  }
}

}  // namespace sim
