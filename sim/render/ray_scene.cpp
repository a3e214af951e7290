#include "sim/render/ray_scene.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>
#include <string>

namespace sim {
namespace {

constexpr std::uint32_t kWhiteTexel = 0x3fffffff;

void Store(float (&to)[3], const glm::vec3& from) {
  for (int c = 0; c < 3; ++c) to[c] = from[c];
}
void Store(float (&to)[2], const glm::vec2& from) {
  for (int c = 0; c < 2; ++c) to[c] = from[c];
}

void Check(const Scene& scene) {
  const auto require = [](bool ok, const std::string& what) {
    if (!ok) throw std::invalid_argument("scene: " + what);
  };
  for (const Material& m : scene.materials) {
    require(m.texture >= -1 && m.texture < static_cast<int>(scene.textures.size()),
            "material " + m.name + ": no such texture");
  }
  for (const Mesh& mesh : scene.meshes) {
    const std::size_t n = mesh.positions.size();
    require(mesh.material >= 0 && mesh.material < static_cast<int>(scene.materials.size()),
            "mesh " + mesh.name + ": no such material");
    require((mesh.normals.empty() || mesh.normals.size() == n) && (mesh.uvs.empty() || mesh.uvs.size() == n) &&
                (mesh.colors.empty() || mesh.colors.size() == n),
            "mesh " + mesh.name + ": its per-vertex arrays differ in length");
    require(!mesh.uvs.empty() || scene.materials[static_cast<std::size_t>(mesh.material)].texture < 0,
            "mesh " + mesh.name + ": textured, but without texture coordinates");
    for (const glm::uvec3& t : mesh.triangles) {
      require(t.x < n && t.y < n && t.z < n, "mesh " + mesh.name + ": a triangle names a vertex that does not exist");
    }
  }
}

}  // namespace

RayScene::RayScene(const Scene& scene) {
  Check(scene);
  AppendTextures(scene);
  bool any_colors = false;
  for (const Mesh& mesh : scene.meshes) any_colors = any_colors || !mesh.colors.empty();
  for (const Mesh& mesh : scene.meshes) AppendMesh(scene, mesh, any_colors);
  if (triangles_.empty()) {  // rays still look up triangle 0 in lanes that met nothing
    shading_.emplace_back();
    colors_.emplace_back();
    if (materials_.empty()) materials_.push_back({{0, 0, 0}, {0, 0, 0}, 0, 1});
  }
  Build();

  packet_scene_.embree = scene_.get();
  packet_scene_.triangles = shading_.data();
  packet_scene_.colors = any_colors ? colors_.data() : nullptr;
  packet_scene_.materials = materials_.data();
  packet_scene_.levels = levels_.data();
  packet_scene_.texels = texels_.data();
  glm::dvec3 ambient(0.0);
  for (const Light& light : scene.lights) {
    if (const auto* a = std::get_if<AmbientLight>(&light)) ambient += a->radiance;
  }
  Store(packet_scene_.ambient, glm::vec3(ambient));
  Store(packet_scene_.background, scene.background);
}

// Level 0 is a white texel: what a material without texture looks up, so that the inner loop need not ask.
void RayScene::AppendTextures(const Scene& scene) {
  texels_.push_back(kWhiteTexel);
  levels_.push_back({1, 1, 0});
  std::vector<std::int32_t> first_level;
  for (const Texture& texture : scene.textures) {
    first_level.push_back(static_cast<std::int32_t>(levels_.size()));
    if (texels_.size() + texture.texels().size() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) {
      throw std::invalid_argument("scene: more than 2^31 texels in all textures");
    }
    for (const TextureLevel& level : texture.levels()) {
      levels_.push_back({level.width, level.height, static_cast<std::int32_t>(texels_.size() + level.first)});
    }
    texels_.insert(texels_.end(), texture.texels().begin(), texture.texels().end());
  }
  for (const Material& material : scene.materials) {
    MaterialShading m{};
    Store(m.base_color, material.base_color);
    Store(m.emission, material.emission);
    m.level_count = 1;
    if (material.texture >= 0) {
      const auto texture = static_cast<std::size_t>(material.texture);
      m.first_level = first_level[texture];
      m.level_count = static_cast<std::int32_t>(scene.textures[texture].levels().size());
    }
    materials_.push_back(m);
  }
}

void RayScene::AppendMesh(const Scene& scene, const Mesh& mesh, bool any_colors) {
  const auto first = static_cast<std::uint32_t>(positions_.size());
  first_triangle_.push_back(static_cast<std::uint32_t>(triangles_.size()));
  positions_.insert(positions_.end(), mesh.positions.begin(), mesh.positions.end());
  const int texture = scene.materials[static_cast<std::size_t>(mesh.material)].texture;
  for (const glm::uvec3& t : mesh.triangles) {
    triangles_.emplace_back(first + t);
    TriangleShading s{};
    s.material = mesh.material;
    const glm::dvec3 p0(mesh.positions[t.x]), p1(mesh.positions[t.y]), p2(mesh.positions[t.z]);
    const glm::dvec3 cross = glm::cross(p1 - p0, p2 - p0);
    const double area = glm::length(cross);
    if (mesh.normals.empty()) {
      Store(s.normal, area > 0 ? glm::vec3(cross / area) : glm::vec3(0, 0, 1));
    } else {
      const glm::vec3 n = mesh.normals[t.x];
      Store(s.normal, n);
      Store(s.normal_du, mesh.normals[t.y] - n);
      Store(s.normal_dv, mesh.normals[t.z] - n);
    }
    if (texture >= 0) {
      const Texture& picture = scene.textures[static_cast<std::size_t>(texture)];
      const glm::dvec2 uv(mesh.uvs[t.x]), du = glm::dvec2(mesh.uvs[t.y]) - uv, dv = glm::dvec2(mesh.uvs[t.z]) - uv;
      Store(s.uv, glm::vec2(uv - glm::floor(uv)));  // pictures repeat: near 0 floats are finest
      Store(s.uv_du, glm::vec2(du));
      Store(s.uv_dv, glm::vec2(dv));
      const double texels = std::abs(du.x * dv.y - du.y * dv.x) * picture.width() * picture.height();
      s.texels_per_metre = area > 0 ? static_cast<float>(std::sqrt(texels / area)) : 0.0f;
    }
    shading_.push_back(s);
    if (any_colors) {
      TriangleColor c{{1, 1, 1}, {0, 0, 0}, {0, 0, 0}};
      if (!mesh.colors.empty()) {
        const glm::vec3 color = mesh.colors[t.x];
        Store(c.color, color);
        Store(c.color_du, mesh.colors[t.y] - color);
        Store(c.color_dv, mesh.colors[t.z] - color);
      }
      colors_.push_back(c);
    }
  }
}

std::uint32_t RayScene::MeshOf(std::uint32_t triangle) const {
  const auto next = std::upper_bound(first_triangle_.begin(), first_triangle_.end(), triangle);
  return static_cast<std::uint32_t>(next - first_triangle_.begin()) - 1;
}

void RayScene::Build() {
  device_.reset(rtcNewDevice(nullptr));
  if (!device_) throw std::runtime_error("Embree: no device, error " + std::to_string(rtcGetDeviceError(nullptr)));
  scene_.reset(rtcNewScene(device_.get()));
  rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);  // no ray slips through between two triangles
  if (!triangles_.empty()) {
    RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3),
                                             positions_.size());
    void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(glm::uvec3),
                                            triangles_.size());
    if (vertices != nullptr && indices != nullptr) {
      std::copy(positions_.begin(), positions_.end(), static_cast<glm::vec3*>(vertices));
      std::copy(triangles_.begin(), triangles_.end(), static_cast<glm::uvec3*>(indices));
      rtcCommitGeometry(geometry);
      rtcAttachGeometry(scene_.get(), geometry);
    }
    rtcReleaseGeometry(geometry);
  }
  // In one thread: where triangles touch, which one a ray meets may depend on the tree, and the tree on the threads.
  tbb::task_arena(1).execute([this] { rtcCommitScene(scene_.get()); });
  const RTCError error = rtcGetDeviceError(device_.get());
  if (error != RTC_ERROR_NONE)
    throw std::runtime_error("Embree: building the scene failed, error " + std::to_string(error));
}

}  // namespace sim
