#include "sim/render/ray_scene.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>

namespace sim {
namespace {

constexpr std::uint32_t kWhiteTexel = 0x3fffffff, kFlatNormalTexel = 512u | (512u << 10) | (1023u << 20);

void Store(float (&to)[3], const glm::vec3& from) {
  for (int c = 0; c < 3; ++c) to[c] = from[c];
}
void Store(float (&to)[2], const glm::vec2& from) {
  for (int c = 0; c < 2; ++c) to[c] = from[c];
}

bool IsTextured(const Material& m) {
  return m.texture >= 0 || m.emission_texture >= 0 || m.normal_map >= 0 || m.gloss_texture >= 0;
}

// Whether Embree has to ask about each hit.
bool IsCutOut(const Scene& scene, const Material& m) {
  if (!(m.alpha_cutoff > 0)) return false;
  return m.alpha < m.alpha_cutoff ||
         (m.texture >= 0 && scene.textures[static_cast<std::size_t>(m.texture)].has_alpha());
}

// Asked for each hit of the second geometry by a ray: leaves valid[i] as it is where there is a surface, else sets it
// to 0.
void FilterHits(const RTCFilterFunctionNArguments* arguments, bool shadow) {
  const auto* filters = static_cast<const RayScene::Filter*>(arguments->geometryUserPtr);
  const unsigned n = arguments->N;
  for (unsigned i = 0; i < n; ++i) {
    if (arguments->valid[i] == 0) continue;
    const RayScene::Filter& filter = filters[RTCHitN_primID(arguments->hit, n, i)];
    if (filter.lamp) {
      const float along = RTCHitN_Ng_x(arguments->hit, n, i) * RTCRayN_dir_x(arguments->ray, n, i) +
                          RTCHitN_Ng_y(arguments->hit, n, i) * RTCRayN_dir_y(arguments->ray, n, i) +
                          RTCHitN_Ng_z(arguments->hit, n, i) * RTCRayN_dir_z(arguments->ray, n, i);
      if (shadow || along > 0) arguments->valid[i] = 0;
      continue;
    }
    const float u = RTCHitN_u(arguments->hit, n, i), v = RTCHitN_v(arguments->hit, n, i);
    const float alpha =
        filter.factor *
        (filter.alpha != nullptr ? filter.alpha->Alpha(filter.uv + u * filter.uv_du + v * filter.uv_dv) : 1.0f);
    if (alpha < filter.cutoff) arguments->valid[i] = 0;
  }
}
void FilterIntersect(const RTCFilterFunctionNArguments* arguments) { FilterHits(arguments, false); }
void FilterOccluded(const RTCFilterFunctionNArguments* arguments) { FilterHits(arguments, true); }

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
    require(!mesh.uvs.empty() || !IsTextured(scene.materials[static_cast<std::size_t>(mesh.material)]),
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
  light_ = light.samples;
  light_.resize(light_.size() + 16);  // lanes of weight 0 may look past the end
  packet_scene_.light = light_.data();
  packet_scene_.light_layers = static_cast<std::int32_t>(light.layers.size());
  packet_scene_.light_stride = static_cast<std::int32_t>(count);
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
    pictures_.push_back({static_cast<std::int32_t>(levels_.size()), static_cast<std::int32_t>(texture.levels().size())});
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
    m.normal_scale = material.normal_scale;
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
  const bool textured = IsTextured(material);
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

std::uint32_t RayScene::MeshOf(std::uint32_t triangle) const {
  const auto next = std::upper_bound(first_triangle_.begin(), first_triangle_.end(), triangle);
  return mesh_index_[static_cast<std::size_t>(next - first_triangle_.begin()) - 1];
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
        for (const glm::vec3& p : mesh.positions) object.low = glm::min(object.low, p), object.high = glm::max(object.high, p);
      }
    }
    mesh_index += moving.meshes.size();
  }
}

void RayScene::Attach(RTCScene to, std::size_t begin, std::size_t end, bool filtered, std::size_t first_filter) const {
  RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  const std::span<const glm::uvec3> triangles(triangles_.data() + begin, end - begin);
  std::uint32_t low = ~0u, high = 0;  // of the vertices
  for (const glm::uvec3& t : triangles) low = std::min({low, t.x, t.y, t.z}), high = std::max({high, t.x, t.y, t.z});
  void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3),
                                           std::size_t{high} - low + 1);
  void* indices =
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(glm::uvec3), triangles.size());
  if (vertices != nullptr && indices != nullptr) {
    std::copy(positions_.begin() + low, positions_.begin() + high + 1, static_cast<glm::vec3*>(vertices));
    std::transform(triangles.begin(), triangles.end(), static_cast<glm::uvec3*>(indices),
                   [low](const glm::uvec3& t) { return t - low; });
    if (filtered) {
      rtcSetGeometryUserData(geometry, const_cast<Filter*>(filters_.data() + first_filter));  // Embree only hands it on
      rtcSetGeometryIntersectFilterFunction(geometry, FilterIntersect);
      rtcSetGeometryOccludedFilterFunction(geometry, FilterOccluded);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(to, geometry, filtered ? 1 : 0);
  }
  rtcReleaseGeometry(geometry);
}

EmbreeScene RayScene::NewTree() const {
  EmbreeScene tree(rtcNewScene(device_.get()));
  rtcSetSceneFlags(tree.get(), RTC_SCENE_FLAG_ROBUST);  // no ray slips through between two triangles
  return tree;
}

void RayScene::Build() {
  device_.reset(rtcNewDevice(nullptr));
  if (!device_) throw std::runtime_error("Embree: no device, error " + std::to_string(rtcGetDeviceError(nullptr)));
  // In one thread: where triangles touch, which one a ray meets may depend on the tree, and the tree on the threads.
  const auto commit = [](RTCScene tree) { tbb::task_arena(1).execute([tree] { rtcCommitScene(tree); }); };
  scene_ = NewTree();
  if (filtered_first_ > 0) Attach(scene_.get(), 0, filtered_first_, false, 0);
  if (filtered_first_ < still_triangles_) Attach(scene_.get(), filtered_first_, still_triangles_, true, 0);
  commit(scene_.get());
  std::size_t first_filter = still_triangles_ - filtered_first_;
  for (std::size_t k = 0; k < objects_.size(); ++k) {
    const auto begin = static_cast<std::size_t>(first_triangles_[2 * k]),
               filtered = static_cast<std::size_t>(first_triangles_[2 * k + 1]),
               end = k + 1 < objects_.size() ? static_cast<std::size_t>(first_triangles_[2 * k + 2]) : triangles_.size();
    objects_[k].tree = NewTree();
    if (begin < filtered) Attach(objects_[k].tree.get(), begin, filtered, false, 0);
    if (filtered < end) Attach(objects_[k].tree.get(), filtered, end, true, first_filter);
    first_filter += end - filtered;
    commit(objects_[k].tree.get());
  }
  const RTCError error = rtcGetDeviceError(device_.get());
  if (error != RTC_ERROR_NONE)
    throw std::runtime_error("Embree: building the scene failed, error " + std::to_string(error));
}

}  // namespace sim
