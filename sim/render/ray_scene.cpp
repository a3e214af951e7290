#include "sim/render/ray_scene.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>
#include <string>

namespace sim {
namespace {

void Check(const Scene& scene) {
  const auto require = [](bool ok, const std::string& what) {
    if (!ok) throw std::invalid_argument("scene: " + what);
  };
  for (const Material& m : scene.materials) {
    for (const int texture : {m.texture, m.emission_texture, m.normal_map, m.gloss_texture}) {
      require(texture >= -1 && texture < static_cast<int>(scene.textures.size()),
              "material " + m.name + ": no such texture");
    }
    require(m.normal_map < 0 ||
                scene.textures[static_cast<std::size_t>(m.normal_map)].content() == Texture::Content::numbers,
            "material " + m.name + ": its normal map is not one");
    require(m.gloss_texture < 0 ||
                scene.textures[static_cast<std::size_t>(m.gloss_texture)].content() == Texture::Content::numbers,
            "material " + m.name + ": its metallic-roughness picture is one of colours");
  }
  require(scene.materials.size() < (1u << kMaterialBits), "too many materials");
  const auto check = [&](const Mesh& mesh) {
    const std::size_t n = mesh.positions.size();
    require(mesh.material >= 0 && mesh.material < static_cast<int>(scene.materials.size()),
            "mesh " + mesh.name + ": no such material");
    require((mesh.normals.empty() || mesh.normals.size() == n) && (mesh.uvs.empty() || mesh.uvs.size() == n) &&
                (mesh.colors.empty() || mesh.colors.size() == n),
            "mesh " + mesh.name + ": its per-vertex arrays differ in length");
    require(!mesh.uvs.empty() || !scene.materials[static_cast<std::size_t>(mesh.material)].HasPicture(),
            "mesh " + mesh.name + ": textured, but without texture coordinates");
    for (const glm::uvec3& t : mesh.triangles) {
      require(t.x < n && t.y < n && t.z < n, "mesh " + mesh.name + ": a triangle names a vertex that does not exist");
    }
  };
  for (const Mesh& mesh : scene.meshes) check(mesh);
  for (const MovingObject& object : scene.objects) {
    require(object.motion != nullptr, "object " + object.name + ": has no motion");
    for (const Mesh& mesh : object.meshes) check(mesh);
  }
}

}  // namespace

void CheckScene(const Scene& scene) { Check(scene); }

RayScene::RayScene(const Scene& scene) {
  Check(scene);
  AppendTextures(scene);
  std::size_t mesh_count = 0;
  const auto take_in = [&](const std::vector<Mesh>& meshes) {
    mesh_count += meshes.size();
    for (const Mesh& mesh : meshes) {
      any_normals_ = any_normals_ || !mesh.normals.empty();
      any_colors_ = any_colors_ || !mesh.colors.empty();
      any_tangents_ = any_tangents_ || scene.materials[static_cast<std::size_t>(mesh.material)].normal_map >= 0;
    }
  };
  take_in(scene.meshes);
  for (const MovingObject& object : scene.objects) take_in(object.meshes);
  alpha_textures_.reserve(mesh_count);  // filters point at them
  for (const bool cut_out : {false, true}) {
    filtered_first_ = static_cast<std::uint32_t>(triangles_.size());
    for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
      const Mesh& mesh = scene.meshes[i];
      const Material& material = scene.materials[static_cast<std::size_t>(mesh.material)];
      if (IsCutOut(scene, material) == cut_out) AppendMesh(scene, mesh, material, mesh.material, i, false);
    }
  }
  AppendLamps(scene);
  still_triangles_ = static_cast<std::uint32_t>(triangles_.size());
  AppendObjects(scene);
  if (triangles_.empty()) {  // rays still look up triangle 0 in lanes that met nothing
    shading_.emplace_back();
    if (any_normals_) normals_.emplace_back();
    if (any_colors_) colors_.emplace_back();
    if (any_tangents_) tangents_.emplace_back();
    if (materials_.empty()) materials_.push_back({{0, 0, 0}, {0, 0, 0}, {0, 1}, {0, 1}, {1, 1}, 1.0f});
  }
  Build();

  PacketScene& p = packet_scene_;
  p.embree = scene_.get();
  p.filtered_first = static_cast<std::int32_t>(filtered_first_);
  p.triangles = shading_.data();
  p.normals = any_normals_ ? normals_.data() : nullptr;
  p.colors = any_colors_ ? colors_.data() : nullptr;
  p.tangents = any_tangents_ ? tangents_.data() : nullptr;
  p.materials = materials_.data();
  p.levels = levels_.data();
  p.texels = texels_.data();
  for (const MaterialShading& m : materials_) {
    const bool emits = m.emission[0] > 0 || m.emission[1] > 0 || m.emission[2] > 0;
    p.any_emission = p.any_emission || emits;
    p.any_emission_picture = p.any_emission_picture || (emits && m.emission_picture.first_level > 0);
  }
  glm::dvec3 ambient(0.0);
  for (const Light& light : scene.lights) {
    if (const auto* a = std::get_if<AmbientLight>(&light)) ambient += a->radiance;
  }
  Store(p.ambient, glm::vec3(ambient));
  const Sky sky = scene.sky ? *scene.sky : Sky{scene.background, scene.background, scene.background, 0, 0, {}, 0.0};
  Store(p.sky.zenith, sky.zenith);
  Store(p.sky.horizon, sky.horizon);
  Store(p.sky.ground, sky.ground);
  if (sky.picture.empty()) return;
  for (int y = 0; y < sky.height; ++y) {
    for (int x = 0; x <= sky.width; ++x) {
      const glm::vec3& pixel = sky.picture[static_cast<std::size_t>(y) * static_cast<std::size_t>(sky.width) +
                                           static_cast<std::size_t>(x % sky.width)];
      for (int c = 0; c < 3; ++c) sky_picture_.push_back(pixel[c]);
    }
  }
  p.sky.picture = sky_picture_.data();
  p.sky.width = sky.width;
  p.sky.height = sky.height;
  p.sky.turn = static_cast<float>(sky.turn - std::floor(sky.turn));
}

void RayScene::SetLight(const BakedLight& light) {
  if (light.resolutions.size() != still_triangles_ || light.layers.empty() ||
      light.layers.size() > static_cast<std::size_t>(kMaxLightLayers)) {
    throw std::invalid_argument("baked light: of another scene");
  }
  std::size_t count = 0;
  for (std::size_t i = 0; i < still_triangles_; ++i) {
    const TriangleResolution r = light.resolutions[i];
    if (r.log2_front > kMaxLog2Resolution || r.log2_back > kMaxLog2Resolution)
      throw std::invalid_argument("baked light: too fine");
    shading_[i].material = MaterialIndex(static_cast<std::uint32_t>(i)) |
                           (std::uint32_t{r.log2_front} | (std::uint32_t{r.log2_back} << 4)) << kMaterialBits;
    shading_[i].first_light = static_cast<std::int32_t>(count);
    count += LatticeSize(std::size_t{1} << r.log2_front) + LatticeSize(std::size_t{1} << r.log2_back);
    if (count > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()) - 16)
      throw std::invalid_argument("baked light: more than 2^31 samples");
  }
  if (light.samples.size() != count * light.layers.size()) throw std::invalid_argument("baked light: of another scene");
  lamps_are_baked_ = light.has_lamps;
  light_ = light.samples;
  light_.resize(light_.size() + 16);  // lanes of weight 0 may look past the end
  packet_scene_.light = light_.data();
  packet_scene_.light_layers = static_cast<std::int32_t>(light.layers.size());
  packet_scene_.light_stride = static_cast<std::int32_t>(count);
}

glm::vec3 RayScene::ShadingNormal(std::uint32_t triangle, float u, float v) const {
  if (!any_normals_) {
    const glm::dvec3 a(Corner(triangle, 0)), b(Corner(triangle, 1)), c(Corner(triangle, 2));
    const glm::dvec3 cross = glm::cross(b - a, c - a);
    return glm::vec3(cross / std::max(glm::length(cross), 1e-300));
  }
  const TriangleNormals& n = normals_[triangle];
  glm::vec3 normal;
  for (int c = 0; c < 3; ++c) normal[c] = n.normal[c] + u * n.normal_du[c] + v * n.normal_dv[c];
  return normal;
}

glm::vec3 RayScene::VertexColor(std::uint32_t triangle, float u, float v) const {
  if (!any_colors_) return glm::vec3(1.0f);
  const TriangleColor& color = colors_[triangle];
  glm::vec3 result;
  for (int c = 0; c < 3; ++c) result[c] = color.color[c] + u * color.color_du[c] + v * color.color_dv[c];
  return result;
}

glm::vec2 RayScene::TextureCoordinates(std::uint32_t triangle, float u, float v) const {
  const TriangleShading& t = shading_[triangle];
  return {t.uv[0] + u * t.uv_du[0] + v * t.uv_dv[0], t.uv[1] + u * t.uv_du[1] + v * t.uv_dv[1]};
}

double RayScene::UvPerMetre(std::uint32_t triangle) const {
  const TriangleShading& t = shading_[triangle];
  const glm::dvec3 a(Corner(triangle, 0)), b(Corner(triangle, 1)), c(Corner(triangle, 2));
  const double area = glm::length(glm::cross(b - a, c - a));
  const double uv_area =
      std::abs(static_cast<double>(t.uv_du[0]) * t.uv_dv[1] - static_cast<double>(t.uv_du[1]) * t.uv_dv[0]);
  return area > 0 ? std::sqrt(uv_area / area) : 0.0;
}

std::uint32_t RayScene::MeshOf(std::uint32_t triangle) const {
  const auto next = std::upper_bound(first_triangle_.begin(), first_triangle_.end(), triangle);
  return mesh_index_[static_cast<std::size_t>(next - first_triangle_.begin()) - 1];
}

}  // namespace sim
