// Scene tables of the ray tracer: the bounding volume hierarchies of Embree, and shading tables. Private to sim.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <type_traits>
#include <vector>

#include "sim/motion/trajectory.h"
#include "sim/render/baked_light.h"
#include "sim/render/packet.h"
#include "sim/world/scene.h"

namespace sim {

// Throws std::invalid_argument for a scene with an index out of range.
void CheckScene(const Scene& scene);

// Into the plain arrays of sim/render/packet.h, and out of them.
template <int kSize, class T>
void Store(float (&to)[kSize], const glm::vec<kSize, T>& from) {
  for (int c = 0; c < kSize; ++c) to[c] = static_cast<float>(from[c]);
}
template <int kSize>
OverTriangle<kSize> Over(const std::vector<glm::vec<kSize, float>>& values, const glm::uvec3& t) {
  OverTriangle<kSize> over;
  Store(over.first, values[t.x]);
  Store(over.du, values[t.y] - values[t.x]);
  Store(over.dv, values[t.z] - values[t.x]);
  return over;
}
// The same for texture coordinates, shifted near 0, where floats are finest (textures repeat); and for colours, white
// without any.
OverTriangle<2> UvsOver(const Mesh& mesh, const glm::uvec3& t);
OverTriangle<3> ColorsOver(const Mesh& mesh, const glm::uvec3& t);
template <int kSize>
glm::vec<kSize, float> At(const OverTriangle<kSize>& over, float u, float v) {
  glm::vec<kSize, float> value;
  for (int c = 0; c < kSize; ++c) value[c] = over.first[c] + u * over.du[c] + v * over.dv[c];
  return value;
}

struct EmbreeRelease {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using EmbreeDevice = std::unique_ptr<std::remove_pointer_t<RTCDevice>, EmbreeRelease>;
using EmbreeScene = std::unique_ptr<std::remove_pointer_t<RTCScene>, EmbreeRelease>;

EmbreeScene NewTree(RTCDevice device);
// Which of two triangles a ray meets where they touch depends on the tree, and the tree not on the threads.
void CommitTree(const EmbreeScene& tree);
// Throws std::runtime_error when Embree has failed at `what`.
void CheckEmbree(RTCDevice device, const char* what);

// One object that moves, as an Embree scene in its own frame O.
struct RayObject {
  std::shared_ptr<const Trajectory> motion;
  EmbreeScene tree;
  glm::vec3 low{0.0f}, high{0.0f};  // a box around it

  Pose PoseAt(double t_s) const { return motion->At(t_s).pose; }
};

// Triangles are numbered through all meshes, in two Embree geometries: first the opaque ones, then those with a filter
// that Embree calls at each hit (cut-outs, visible lamps). Triangle() maps a hit to the index into every table. Those
// of objects, two geometries in each one's own tree, come after all static ones and have no baked light.
class RayScene {
 public:
  // Throws std::invalid_argument for a scene with an index out of range, std::runtime_error when Embree fails.
  explicit RayScene(const Scene& scene);

  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  // Replaces ambient light by this light. Throws std::invalid_argument when it is another scene's.
  void SetLight(const BakedLight& light);
  bool lamps_are_baked() const { return lamps_are_baked_; }
  // Enables specular reflection of metal and gloss (Material::Mirrors).
  void AddReflections(const Scene& scene);

  const PacketScene& packet_scene() const { return packet_scene_; }
  RTCScene embree() const { return scene_.get(); }  // of what stands still
  RTCDevice device() const { return device_.get(); }
  const std::vector<RayObject>& objects() const { return objects_; }
  const std::int32_t* first_triangles() const { return first_triangles_.data(); }  // PacketObjects has what they are

  // instance: RTC_INVALID_GEOMETRY_ID of what stands still, else the object.
  std::uint32_t Triangle(std::uint32_t instance, std::uint32_t geometry, std::uint32_t primitive) const {
    if (instance == RTC_INVALID_GEOMETRY_ID) return primitive + (geometry == 1 ? filtered_first_ : 0u);
    return primitive + static_cast<std::uint32_t>(first_triangles_[2 * instance + geometry]);
  }
  std::uint32_t triangle_count() const { return still_triangles_; }  // of what stands still
  // Corner 0 ... 2 of a triangle, in W, of an object's in O.
  const glm::vec3& Corner(std::uint32_t triangle, int corner) const { return positions_[triangles_[triangle][corner]]; }
  // (corner 1 - corner 0) x (corner 2 - corner 0): twice the area long.
  glm::dvec3 AreaNormal(std::uint32_t triangle) const;
  // Index in Scene::meshes of the mesh that a triangle is of; visible lamps count on behind the meshes, objects' meshes
  // behind those.
  std::uint32_t MeshOf(std::uint32_t triangle) const;
  // The triangle's shading tables interpolated at (u, v); the normal is not normalised and not oriented towards the
  // viewer.
  glm::vec3 ShadingNormal(std::uint32_t triangle, float u, float v) const;
  glm::vec3 VertexColor(std::uint32_t triangle, float u, float v) const;
  glm::vec2 TextureCoordinates(std::uint32_t triangle, float u, float v) const;
  // Square root of the ratio of the areas in texture coordinates and in W.
  double UvPerMetre(std::uint32_t triangle) const;
  std::uint32_t MaterialIndex(std::uint32_t triangle) const {
    return shading_[triangle].material & ((1u << kMaterialBits) - 1);
  }

  // Data of a triangle of the second geometry for Embree's filter.
  struct Filter {
    OverTriangle<2> uv;
    const Texture* alpha = nullptr;
    float factor = 1.0f, cutoff = 0.0f;
    bool lamp = false, one_sided = false;
  };

 private:
  void AppendTextures(const Scene& scene);
  // Returns the first triangles of what is there everywhere, and of cut-outs and one-sided meshes, which come behind.
  std::array<std::uint32_t, 2> AppendMeshes(const Scene& scene, const std::vector<Mesh>& meshes,
                                            std::size_t mesh_index);
  void AppendMesh(const Scene& scene, const Mesh& mesh, const Material& material, std::size_t mesh_index, bool lamp);
  void AppendLamps(const Scene& scene);
  void AppendObjects(const Scene& scene);
  // Triangles [begin, end) as a geometry of `to`, with the filters from first_filter on where there are any.
  void Attach(RTCScene to, std::size_t begin, std::size_t end, bool filtered, std::size_t first_filter) const;
  void Build();

  std::vector<glm::vec3> positions_;
  std::vector<glm::uvec3> triangles_;
  std::vector<std::uint32_t> first_triangle_;  // of each mesh that has been appended,
  std::vector<std::uint32_t> mesh_index_;      // and its index
  std::uint32_t filtered_first_ = 0, still_triangles_ = 0;
  std::vector<std::int32_t> first_triangles_;  // of each object: of its two geometries
  std::vector<Filter> filters_;
  std::vector<Texture> textures_;  // the scene's
  std::vector<TriangleShading> shading_;
  std::vector<OverTriangle<3>> normals_;    // or none
  std::vector<OverTriangle<3>> colors_;     // or none
  std::vector<TriangleTangents> tangents_;  // or none
  bool any_normals_ = false, any_colors_ = false, any_tangents_ = false, lamps_are_baked_ = false;
  std::vector<MaterialShading> materials_;
  std::vector<GlossShading> gloss_;
  std::vector<LampShading> lamps_;
  std::vector<PictureShading> pictures_;  // by texture
  std::vector<LevelShading> levels_;
  std::vector<std::uint32_t> light_;
  std::vector<float> sky_picture_;
  EmbreeDevice device_;
  EmbreeScene scene_;
  std::vector<RayObject> objects_;
  PacketScene packet_scene_{};
};

}  // namespace sim
