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

// Embree's filter for each hit of the second geometry: leaves valid[i] unchanged where the surface is opaque, else sets
// it to 0.
void FilterHits(const RTCFilterFunctionNArguments* arguments, bool shadow) {
  const auto* filters = static_cast<const RayScene::Filter*>(arguments->geometryUserPtr);
  const unsigned n = arguments->N;
  for (unsigned i = 0; i < n; ++i) {
    if (arguments->valid[i] == 0) continue;
    const RayScene::Filter& filter = filters[RTCHitN_primID(arguments->hit, n, i)];
    if (filter.lamp || filter.one_sided) {
      const float along = RTCHitN_Ng_x(arguments->hit, n, i) * RTCRayN_dir_x(arguments->ray, n, i) +
                          RTCHitN_Ng_y(arguments->hit, n, i) * RTCRayN_dir_y(arguments->ray, n, i) +
                          RTCHitN_Ng_z(arguments->hit, n, i) * RTCRayN_dir_z(arguments->ray, n, i);
      if ((filter.lamp && shadow) || along > 0) arguments->valid[i] = 0;
      if (filter.lamp || arguments->valid[i] == 0) continue;
    }
    const float u = RTCHitN_u(arguments->hit, n, i), v = RTCHitN_v(arguments->hit, n, i);
    const float alpha = filter.factor * (filter.alpha != nullptr ? filter.alpha->Alpha(At(filter.uv, u, v)) : 1.0f);
    if (alpha < filter.cutoff) arguments->valid[i] = 0;
  }
}

void FilterIntersect(const RTCFilterFunctionNArguments* arguments) { FilterHits(arguments, false); }

void FilterOccluded(const RTCFilterFunctionNArguments* arguments) { FilterHits(arguments, true); }

}  // namespace

void CheckScene(const Scene& scene) {
  const auto require = [](bool ok, const std::string& what) {
    if (!ok) throw std::invalid_argument("scene: " + what);
  };
  for (const Material& m : scene.materials) {
    for (const int texture : {m.texture, m.emission_texture, m.normal_map, m.gloss_texture}) {
      require(texture >= -1 && texture < static_cast<int>(scene.textures.size()),
              "material " + m.name + ": no such texture");
    }
    const auto has_numbers = [&](int texture) {
      return texture < 0 || scene.textures[static_cast<std::size_t>(texture)].content() == Texture::Content::numbers;
    };
    require(has_numbers(m.normal_map), "material " + m.name + ": its normal map is not one");
    require(has_numbers(m.gloss_texture), "material " + m.name + ": its metallic-roughness picture is one of colours");
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
    require(std::ranges::all_of(mesh.triangles, [n](const glm::uvec3& t) { return t.x < n && t.y < n && t.z < n; }),
            "mesh " + mesh.name + ": a triangle names a vertex that does not exist");
  };
  for (const Mesh& mesh : scene.meshes) check(mesh);
  for (const MovingObject& object : scene.objects) {
    require(object.motion != nullptr, "object " + object.name + ": has no motion");
    for (const Mesh& mesh : object.meshes) check(mesh);
  }
}

RayScene::RayScene(const Scene& scene) {
  CheckScene(scene);
  AppendTextures(scene);
  std::size_t vertices = 4 * scene.lights.size(), triangles = 2 * scene.lights.size();  // of lamps, at most
  const auto take_in = [&](const std::vector<Mesh>& meshes) {
    for (const Mesh& mesh : meshes) {
      vertices += mesh.positions.size();
      triangles += mesh.triangles.size();
      any_normals_ = any_normals_ || !mesh.normals.empty();
      any_colors_ = any_colors_ || !mesh.colors.empty();
      any_tangents_ = any_tangents_ || scene.materials[static_cast<std::size_t>(mesh.material)].normal_map >= 0;
    }
  };
  take_in(scene.meshes);
  for (const MovingObject& object : scene.objects) take_in(object.meshes);
  positions_.reserve(vertices + 1);  // Embree reads 16 bytes of each
  triangles_.reserve(triangles);
  shading_.reserve(triangles);
  if (any_normals_) normals_.reserve(triangles);
  filtered_first_ = AppendMeshes(scene, scene.meshes, 0)[1];
  AppendLamps(scene);
  still_triangles_ = static_cast<std::uint32_t>(triangles_.size());
  AppendObjects(scene);
  if (triangles_.empty()) {  // lanes without a hit still look up triangle 0
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
  light_.resize(light_.size() + 16);  // lanes of weight 0 may read past the end
  packet_scene_.light = light_.data();
  packet_scene_.light_layers = static_cast<std::int32_t>(light.layers.size());
  packet_scene_.light_stride = static_cast<std::int32_t>(count);
}

glm::dvec3 RayScene::AreaNormal(std::uint32_t triangle) const {
  const glm::dvec3 a(Corner(triangle, 0)), b(Corner(triangle, 1)), c(Corner(triangle, 2));
  return glm::cross(b - a, c - a);
}

glm::vec3 RayScene::ShadingNormal(std::uint32_t triangle, float u, float v) const {
  if (any_normals_) return At(normals_[triangle], u, v);
  const glm::dvec3 normal = AreaNormal(triangle);
  return glm::vec3(normal / std::max(glm::length(normal), 1e-300));
}

glm::vec3 RayScene::VertexColor(std::uint32_t triangle, float u, float v) const {
  return any_colors_ ? At(colors_[triangle], u, v) : glm::vec3(1.0f);
}

glm::vec2 RayScene::TextureCoordinates(std::uint32_t triangle, float u, float v) const {
  return At(shading_[triangle].uv, u, v);
}

double RayScene::UvPerMetre(std::uint32_t triangle) const {
  const OverTriangle<2>& uv = shading_[triangle].uv;
  const double area = glm::length(AreaNormal(triangle));
  const double uv_area = std::abs(static_cast<double>(uv.du[0]) * uv.dv[1] - static_cast<double>(uv.du[1]) * uv.dv[0]);
  return area > 0 ? std::sqrt(uv_area / area) : 0.0;
}

std::uint32_t RayScene::MeshOf(std::uint32_t triangle) const {
  const auto next = std::upper_bound(first_triangle_.begin(), first_triangle_.end(), triangle);
  return mesh_index_[static_cast<std::size_t>(next - first_triangle_.begin()) - 1];
}

void RayScene::Attach(RTCScene to, std::size_t begin, std::size_t end, bool filtered, std::size_t first_filter) const {
  RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, positions_.data(), 0,
                             sizeof(glm::vec3), positions_.size());
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, triangles_.data(),
                             begin * sizeof(glm::uvec3), sizeof(glm::uvec3), end - begin);
  if (filtered) {
    rtcSetGeometryUserData(geometry, const_cast<Filter*>(filters_.data() + first_filter));  // Embree passes it on
    rtcSetGeometryIntersectFilterFunction(geometry, FilterIntersect);
    rtcSetGeometryOccludedFilterFunction(geometry, FilterOccluded);
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(to, geometry, filtered ? 1 : 0);
  rtcReleaseGeometry(geometry);
}

EmbreeScene NewTree(RTCDevice device) {
  EmbreeScene tree(rtcNewScene(device));
  rtcSetSceneFlags(tree.get(), RTC_SCENE_FLAG_ROBUST);  // watertight at edges between triangles
  return tree;
}

void CommitTree(const EmbreeScene& tree) {
  tbb::this_task_arena::isolate([&] { rtcCommitScene(tree.get()); });  // without the caller's other tasks
}

void CheckEmbree(RTCDevice device, const char* what) {
  const RTCError error = rtcGetDeviceError(device);
  if (error != RTC_ERROR_NONE)
    throw std::runtime_error(std::string("Embree: ") + what + " failed, error " + std::to_string(error));
}

void RayScene::Build() {
  device_.reset(rtcNewDevice(nullptr));
  if (!device_) throw std::runtime_error("Embree: no device, error " + std::to_string(rtcGetDeviceError(nullptr)));
  scene_ = NewTree(device_.get());
  if (filtered_first_ > 0) Attach(scene_.get(), 0, filtered_first_, false, 0);
  if (filtered_first_ < still_triangles_) Attach(scene_.get(), filtered_first_, still_triangles_, true, 0);
  CommitTree(scene_);
  std::size_t first_filter = still_triangles_ - filtered_first_;
  for (std::size_t k = 0; k < objects_.size(); ++k) {
    const auto begin = static_cast<std::size_t>(first_triangles_[2 * k]),
               filtered = static_cast<std::size_t>(first_triangles_[2 * k + 1]),
               end =
                   k + 1 < objects_.size() ? static_cast<std::size_t>(first_triangles_[2 * k + 2]) : triangles_.size();
    objects_[k].tree = NewTree(device_.get());
    if (begin < filtered) Attach(objects_[k].tree.get(), begin, filtered, false, 0);
    if (filtered < end) Attach(objects_[k].tree.get(), filtered, end, true, first_filter);
    first_filter += end - filtered;
    CommitTree(objects_[k].tree);
  }
  CheckEmbree(device_.get(), "building the scene");
}

}  // namespace sim
