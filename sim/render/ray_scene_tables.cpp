// Lookup tables for hits: triangles, materials, pictures, lamps.
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>

#include "sim/render/ray_scene.h"

namespace sim {

OverTriangle<2> UvsOver(const Mesh& mesh, const glm::uvec3& t) {
  OverTriangle<2> uv = Over(mesh.uvs, t);
  for (float& c : uv.first) c -= std::floor(c);
  return uv;
}

OverTriangle<3> ColorsOver(const Mesh& mesh, const glm::uvec3& t) {
  return mesh.colors.empty() ? OverTriangle<3>{{1, 1, 1}, {0, 0, 0}, {0, 0, 0}} : Over(mesh.colors, t);
}

// Level 0 is a white texel and level 1 a flat normal, for materials without texture: the inner loop needs no branch.
void RayScene::AppendTextures(const Scene& scene) {
  static constexpr std::uint32_t kWhite = 0x3fffffff, kFlatNormal = 512u | (512u << 10) | (1023u << 20);
  static constexpr std::uint32_t kPlain[2][2] = {{kWhite, kWhite}, {kFlatNormal, kFlatNormal}};
  for (const auto& row : kPlain) levels_.push_back({1u | 1u << 16, row});
  textures_ = scene.textures;
  for (const Texture& texture : textures_) {
    pictures_.push_back(
        {static_cast<std::int32_t>(levels_.size()), static_cast<std::int32_t>(texture.levels().size())});
    for (const TextureLevel& level : texture.levels()) {
      levels_.push_back({static_cast<std::uint32_t>(level.width) | (static_cast<std::uint32_t>(level.height) << 16),
                         &texture.texels()[level.first]});
    }
  }
  const auto picture = [&](int texture, std::int32_t otherwise) {
    return texture < 0 ? PictureShading{otherwise, 1} : pictures_[static_cast<std::size_t>(texture)];
  };
  for (const Material& material : scene.materials) {
    MaterialShading m{};
    Store(m.base_color, material.base_color);
    Store(m.emission, material.emission);
    m.color = picture(material.texture, 0);
    m.emission_picture = picture(material.emission_texture, 0);
    m.normal_map = picture(material.normal_map, 1);
    m.normal_scale = material.normal_map < 0 ? 0.0f : material.normal_scale;  // no texel is flat to the last bit
    materials_.push_back(m);
  }
}

std::array<std::uint32_t, 2> RayScene::AppendMeshes(const Scene& scene, const std::vector<Mesh>& meshes,
                                                    std::size_t mesh_index) {
  std::array<std::uint32_t, 2> first{};
  for (const bool filtered : {false, true}) {
    first[filtered] = static_cast<std::uint32_t>(triangles_.size());
    for (std::size_t i = 0; i < meshes.size(); ++i) {
      const Material& material = scene.materials[static_cast<std::size_t>(meshes[i].material)];
      if ((meshes[i].one_sided || IsCutOut(scene, material)) == filtered)
        AppendMesh(scene, meshes[i], material, mesh_index + i, false);
    }
  }
  return first;
}

void RayScene::AppendMesh(const Scene& scene, const Mesh& mesh, const Material& material, std::size_t mesh_index,
                          bool lamp) {
  const auto first = static_cast<std::uint32_t>(positions_.size());
  first_triangle_.push_back(static_cast<std::uint32_t>(triangles_.size()));
  mesh_index_.push_back(static_cast<std::uint32_t>(mesh_index));
  positions_.insert(positions_.end(), mesh.positions.begin(), mesh.positions.end());
  const bool cut_out = !lamp && IsCutOut(scene, material);
  const Texture* alpha = nullptr;
  if (cut_out && material.texture >= 0 && textures_[static_cast<std::size_t>(material.texture)].has_alpha())
    alpha = &textures_[static_cast<std::size_t>(material.texture)];
  const bool textured = material.HasPicture();
  for (const glm::uvec3& t : mesh.triangles) {
    triangles_.emplace_back(first + t);
    TriangleShading s{};
    s.material = static_cast<std::uint32_t>(mesh.material);
    const glm::dvec3 p0(mesh.positions[t.x]), side_u = glm::dvec3(mesh.positions[t.y]) - p0,
                                              side_v = glm::dvec3(mesh.positions[t.z]) - p0;
    if (textured) s.uv = UvsOver(mesh, t);
    shading_.push_back(s);
    if (any_normals_) {
      OverTriangle<3> n{};
      if (mesh.normals.empty()) {
        const glm::dvec3 cross = glm::cross(side_u, side_v);
        const double area = glm::length(cross);
        Store(n.first, area > 0 ? cross / area : glm::dvec3(0, 0, 1));
      } else {
        n = Over(mesh.normals, t);
      }
      normals_.push_back(n);
    }
    if (any_tangents_) {
      // X = X_0 + a side_u + b side_v and (s, t) = uv + a du + b dv: dX/ds and dX/dt. Up in the picture is -t.
      glm::dvec2 du(0.0), dv(0.0);
      if (textured) {
        du = glm::dvec2(mesh.uvs[t.y]) - glm::dvec2(mesh.uvs[t.x]);
        dv = glm::dvec2(mesh.uvs[t.z]) - glm::dvec2(mesh.uvs[t.x]);
      }
      const double determinant = du.x * dv.y - du.y * dv.x;
      const glm::dvec3 along_s = (dv.y * side_u - du.y * side_v) * (determinant < 0 ? -1.0 : 1.0);
      const glm::dvec3 along_t = (du.x * side_v - dv.x * side_u) * (determinant < 0 ? -1.0 : 1.0);
      TriangleTangents tangents{};
      if (determinant != 0 && glm::length(along_s) > 0 && glm::length(along_t) > 0) {
        Store(tangents.right, glm::normalize(along_s));
        Store(tangents.up, -glm::normalize(along_t));
      }
      tangents_.push_back(tangents);
    }
    if (any_colors_) colors_.push_back(ColorsOver(mesh, t));
    if (cut_out || lamp || mesh.one_sided)
      filters_.push_back({s.uv, alpha, material.alpha, material.alpha_cutoff, lamp, mesh.one_sided});
  }
}

// Visible lamps are black emissive surfaces, seen from one side, which cast no shadow.
void RayScene::AppendLamps(const Scene& scene) {
  std::size_t mesh_index = scene.meshes.size();
  for (const Light& light : scene.lights) {
    const auto* rect = std::get_if<RectLight>(&light);
    if (rect == nullptr || !rect->visible) continue;
    MaterialShading m{};
    Store(m.emission, rect->radiance);
    m.color = m.emission_picture = {0, 1};
    m.normal_map = {1, 1};
    Mesh mesh;
    mesh.material = static_cast<int>(materials_.size());
    materials_.push_back(m);
    for (const glm::dvec3& corner : {rect->corner, rect->corner + rect->side_u,
                                     rect->corner + rect->side_u + rect->side_v, rect->corner + rect->side_v}) {
      mesh.positions.emplace_back(corner);
    }
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    AppendMesh(scene, mesh, Material{}, mesh_index++, true);
  }
}

// Each object's triangles as those of the world: first what is there everywhere, then cut-outs.
void RayScene::AppendObjects(const Scene& scene) {
  std::size_t mesh_index = first_triangle_.size();  // meshes and lamps are before
  for (const MovingObject& moving : scene.objects) {
    RayObject& object = objects_.emplace_back();
    object.motion = moving.motion;
    object.low = glm::vec3(std::numeric_limits<float>::infinity());
    object.high = -object.low;
    for (const Mesh& mesh : moving.meshes) {
      for (const glm::vec3& p : mesh.positions)
        object.low = glm::min(object.low, p), object.high = glm::max(object.high, p);
    }
    for (const std::uint32_t first : AppendMeshes(scene, moving.meshes, mesh_index))
      first_triangles_.push_back(static_cast<std::int32_t>(first));
    mesh_index += moving.meshes.size();
  }
}

void RayScene::AddReflections(const Scene& scene) {
  for (const Material& m : scene.materials) {
    GlossShading gloss{m.metallic, m.roughness, {0, 1}, m.Mirrors() ? -1 : 0};
    if (m.gloss_texture >= 0) gloss.picture = pictures_[static_cast<std::size_t>(m.gloss_texture)];
    gloss_.push_back(gloss);
  }
  gloss_.resize(materials_.size(), {0.0f, 1.0f, {0, 1}, 0});  // of lamps
  if (std::none_of(gloss_.begin(), gloss_.end(), [](const GlossShading& g) { return g.mirrors != 0; })) return;
  const std::vector<Flicker> layers = Flickers(scene.lights);
  for (const Light& light : scene.lights) {
    const auto* rect = std::get_if<RectLight>(&light);
    if (rect == nullptr) continue;
    const glm::dvec3 normal = glm::normalize(glm::cross(rect->side_u, rect->side_v));
    const glm::dvec3 across_u = glm::cross(rect->side_v, normal), across_v = glm::cross(normal, rect->side_u);
    LampShading lamp{};
    Store(lamp.corner, rect->corner);
    Store(lamp.normal, normal);
    Store(lamp.dual_u, across_u / glm::dot(across_u, rect->side_u));
    Store(lamp.dual_v, across_v / glm::dot(across_v, rect->side_v));
    Store(lamp.radiance, rect->radiance);
    lamp.layer = LayerOf(light, layers);
    lamps_.push_back(lamp);
  }
  packet_scene_.gloss = gloss_.data();
  packet_scene_.lamps = lamps_.data();
  packet_scene_.lamp_count = static_cast<std::int32_t>(lamps_.size());
}

}  // namespace sim
