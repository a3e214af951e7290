// The tables that hits are looked up in: of triangles, materials, pictures, lamps.
#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>

#include "sim/render/ray_scene.h"

namespace sim {
namespace {

constexpr std::uint32_t kWhiteTexel = 0x3fffffff, kFlatNormalTexel = 512u | (512u << 10) | (1023u << 20);

}  // namespace

// Level 0 is a white texel and level 1 a flat normal: what a material without texture looks up, so that the inner loop
// need not ask.
void RayScene::AppendTextures(const Scene& scene) {
  const auto append = [&](int width, int height, const std::uint32_t* from) {
    levels_.push_back({static_cast<std::uint32_t>(width) | (static_cast<std::uint32_t>(height) << 16),
                       static_cast<std::int32_t>(texels_.size())});
    for (int y = 0; y < height; ++y, from += width) {
      texels_.insert(texels_.end(), from, from + width);
      texels_.push_back(*from);
    }
  };
  std::size_t count = 4;
  for (const Texture& texture : scene.textures) {
    for (const TextureLevel& level : texture.levels())
      count += static_cast<std::size_t>(level.width + 1) * static_cast<std::size_t>(level.height);
  }
  if (count > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) {
    throw std::invalid_argument("scene: more than 2^31 texels in all textures");
  }
  texels_.reserve(count);
  append(1, 1, &kWhiteTexel);
  append(1, 1, &kFlatNormalTexel);
  for (const Texture& texture : scene.textures) {
    pictures_.push_back(
        {static_cast<std::int32_t>(levels_.size()), static_cast<std::int32_t>(texture.levels().size())});
    for (const TextureLevel& level : texture.levels())
      append(level.width, level.height, texture.texels().data() + level.first);
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

void RayScene::AppendMesh(const Scene& scene, const Mesh& mesh, const Material& material, std::int32_t material_index,
                          std::size_t mesh_index, bool lamp) {
  const auto first = static_cast<std::uint32_t>(positions_.size());
  first_triangle_.push_back(static_cast<std::uint32_t>(triangles_.size()));
  mesh_index_.push_back(static_cast<std::uint32_t>(mesh_index));
  positions_.insert(positions_.end(), mesh.positions.begin(), mesh.positions.end());
  const bool cut_out = !lamp && IsCutOut(scene, material);
  const Texture* alpha = nullptr;
  if (cut_out && material.texture >= 0 && scene.textures[static_cast<std::size_t>(material.texture)].has_alpha()) {
    const Texture& texture = scene.textures[static_cast<std::size_t>(material.texture)];
    const auto known = std::find_if(alpha_textures_.begin(), alpha_textures_.end(),
                                    [&](const Texture& t) { return t.name() == texture.name(); });
    alpha = known != alpha_textures_.end() ? &*known : &alpha_textures_.emplace_back(texture);
  }
  const bool textured = material.HasPicture();
  for (const glm::uvec3& t : mesh.triangles) {
    triangles_.emplace_back(first + t);
    TriangleShading s{};
    s.material = static_cast<std::uint32_t>(material_index);
    const glm::dvec3 p0(mesh.positions[t.x]), side_u = glm::dvec3(mesh.positions[t.y]) - p0,
                                              side_v = glm::dvec3(mesh.positions[t.z]) - p0;
    glm::dvec2 uv(0.0), du(0.0), dv(0.0);
    if (textured) {
      uv = mesh.uvs[t.x];
      du = glm::dvec2(mesh.uvs[t.y]) - uv;
      dv = glm::dvec2(mesh.uvs[t.z]) - uv;
      uv -= glm::floor(uv);  // pictures repeat: near 0 floats are finest
    }
    Store(s.uv, glm::vec2(uv));
    Store(s.uv_du, glm::vec2(du));
    Store(s.uv_dv, glm::vec2(dv));
    shading_.push_back(s);
    if (any_normals_) {
      TriangleNormals n{};
      if (mesh.normals.empty()) {
        const glm::dvec3 cross = glm::cross(side_u, side_v);
        const double area = glm::length(cross);
        Store(n.normal, area > 0 ? glm::vec3(cross / area) : glm::vec3(0, 0, 1));
      } else {
        const glm::vec3 normal = mesh.normals[t.x];
        Store(n.normal, normal);
        Store(n.normal_du, mesh.normals[t.y] - normal);
        Store(n.normal_dv, mesh.normals[t.z] - normal);
      }
      normals_.push_back(n);
    }
    if (any_tangents_) {
      // X = X_0 + a side_u + b side_v and (s, t) = uv + a du + b dv: dX/ds and dX/dt. Up in the picture is -t.
      const double determinant = du.x * dv.y - du.y * dv.x;
      const glm::dvec3 along_s = (dv.y * side_u - du.y * side_v) * (determinant < 0 ? -1.0 : 1.0);
      const glm::dvec3 along_t = (du.x * side_v - dv.x * side_u) * (determinant < 0 ? -1.0 : 1.0);
      TriangleTangents tangents{};
      if (determinant != 0 && glm::length(along_s) > 0 && glm::length(along_t) > 0) {
        Store(tangents.right, glm::vec3(glm::normalize(along_s)));
        Store(tangents.up, glm::vec3(-glm::normalize(along_t)));
      }
      tangents_.push_back(tangents);
    }
    if (any_colors_) {
      TriangleColor c{{1, 1, 1}, {0, 0, 0}, {0, 0, 0}};
      if (!mesh.colors.empty()) {
        const glm::vec3 color = mesh.colors[t.x];
        Store(c.color, color);
        Store(c.color_du, mesh.colors[t.y] - color);
        Store(c.color_dv, mesh.colors[t.z] - color);
      }
      colors_.push_back(c);
    }
    if (cut_out || lamp)
      filters_.push_back(
          {glm::vec2(uv), glm::vec2(du), glm::vec2(dv), alpha, material.alpha, material.alpha_cutoff, lamp});
  }
}

// Visible lamps are black surfaces that emit, seen from one side, and never in a shadow ray's way.
void RayScene::AppendLamps(const Scene& scene) {
  std::size_t mesh_index = scene.meshes.size();
  for (const Light& light : scene.lights) {
    const auto* rect = std::get_if<RectLight>(&light);
    if (rect == nullptr || !rect->visible) continue;
    Material material;
    material.base_color = glm::vec3(0.0f);
    material.emission = glm::vec3(rect->radiance);
    MaterialShading m{};
    Store(m.emission, material.emission);
    m.color = m.emission_picture = {0, 1};
    m.normal_map = {1, 1};
    const auto index = static_cast<std::int32_t>(materials_.size());
    materials_.push_back(m);
    Mesh mesh;
    mesh.name = "lamp";
    for (const glm::dvec3& corner : {rect->corner, rect->corner + rect->side_u,
                                     rect->corner + rect->side_u + rect->side_v, rect->corner + rect->side_v}) {
      mesh.positions.emplace_back(corner);
    }
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    AppendMesh(scene, mesh, material, index, mesh_index++, true);
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
    for (const bool cut_out : {false, true}) {
      first_triangles_.push_back(static_cast<std::int32_t>(triangles_.size()));
      for (std::size_t i = 0; i < moving.meshes.size(); ++i) {
        const Mesh& mesh = moving.meshes[i];
        const Material& material = scene.materials[static_cast<std::size_t>(mesh.material)];
        if (IsCutOut(scene, material) != cut_out) continue;
        AppendMesh(scene, mesh, material, mesh.material, mesh_index + i, false);
        for (const glm::vec3& p : mesh.positions)
          object.low = glm::min(object.low, p), object.high = glm::max(object.high, p);
      }
    }
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
    Store(lamp.corner, glm::vec3(rect->corner));
    Store(lamp.normal, glm::vec3(normal));
    Store(lamp.dual_u, glm::vec3(across_u / glm::dot(across_u, rect->side_u)));
    Store(lamp.dual_v, glm::vec3(across_v / glm::dot(across_v, rect->side_v)));
    Store(lamp.radiance, glm::vec3(rect->radiance));
    lamp.layer = LayerOf(light, layers);
    lamps_.push_back(lamp);
  }
  packet_scene_.gloss = gloss_.data();
  packet_scene_.lamps = lamps_.data();
  packet_scene_.lamp_count = static_cast<std::int32_t>(lamps_.size());
}

}  // namespace sim
