// Purpose: a scene in the form in which rays meet it: Embree's tree, and tables for shading. Private to sim/render and sim/light.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <type_traits>
#include <vector>

#include "sim/light/baked_light.h"
#include "sim/render/packet.h"
#include "sim/world/scene.h"

namespace sim {

// Throws std::invalid_argument for a scene with an index out of range.
void CheckScene(const Scene& scene);

struct EmbreeRelease {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using EmbreeDevice = std::unique_ptr<std::remove_pointer_t<RTCDevice>, EmbreeRelease>;
using EmbreeScene = std::unique_ptr<std::remove_pointer_t<RTCScene>, EmbreeRelease>;

// Triangles are numbered through all meshes, in two Embree geometries: first those that are there everywhere, then those that
// Embree has to ask about at each hit (cut-outs, visible lamps). Triangle() turns a hit into the index into every table.
class RayScene {
 public:
  // Throws std::invalid_argument for a scene with an index out of range, std::runtime_error when Embree fails.
  explicit RayScene(const Scene& scene);

  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  // From now on hits have this light instead of ambient light. Throws std::invalid_argument when it is not this scene's.
  void SetLight(const BakedLight& light);

  const PacketScene& packet_scene() const { return packet_scene_; }
  RTCScene embree() const { return scene_.get(); }

  std::uint32_t Triangle(std::uint32_t geometry, std::uint32_t primitive) const {
    return primitive + (geometry == 1 ? filtered_first_ : 0u);
  }
  std::uint32_t triangle_count() const { return static_cast<std::uint32_t>(triangles_.size()); }
  // Corner 0 ... 2 of a triangle, in W.
  const glm::vec3& Corner(std::uint32_t triangle, int corner) const { return positions_[triangles_[triangle][corner]]; }
  // Index in Scene::meshes of the mesh that a triangle is of; visible lamps count on behind the meshes.
  std::uint32_t MeshOf(std::uint32_t triangle) const;
  // What a triangle's shading tables say, interpolated at (u, v); the normal is neither unit nor turned towards anybody.
  glm::vec3 ShadingNormal(std::uint32_t triangle, float u, float v) const;
  glm::vec3 VertexColor(std::uint32_t triangle, float u, float v) const;
  glm::vec2 TextureCoordinates(std::uint32_t triangle, float u, float v) const;
  double UvPerMetre(std::uint32_t triangle) const;  // square root of the ratio of the areas in texture coordinates and in W
  std::uint32_t MaterialIndex(std::uint32_t triangle) const { return shading_[triangle].material & ((1u << kMaterialBits) - 1); }
  bool IsLamp(std::uint32_t triangle) const { return triangle >= filtered_first_ && filters_[triangle - filtered_first_].lamp; }

  // What Embree's filter needs of a triangle of the second geometry.
  struct Filter {
    glm::vec2 uv, uv_du, uv_dv;
    const Texture* alpha = nullptr;
    float factor = 1.0f, cutoff = 0.0f;
    bool lamp = false;
  };

 private:
  void AppendTextures(const Scene& scene);
  void AppendMesh(const Scene& scene, const Mesh& mesh, const Material& material, std::int32_t material_index, std::size_t mesh_index, bool lamp);
  void AppendLamps(const Scene& scene);
  void Build();

  std::vector<glm::vec3> positions_;
  std::vector<glm::uvec3> triangles_;
  std::vector<std::uint32_t> first_triangle_;  // of each mesh that has been appended,
  std::vector<std::uint32_t> mesh_index_;      // and its index
  std::uint32_t filtered_first_ = 0;
  std::vector<Filter> filters_;
  std::vector<Texture> alpha_textures_;  // copies of those that filters look at
  std::vector<TriangleShading> shading_;
  std::vector<TriangleNormals> normals_;    // or none
  std::vector<TriangleColor> colors_;       // or none
  std::vector<TriangleTangents> tangents_;  // or none
  bool any_normals_ = false, any_colors_ = false, any_tangents_ = false;
  std::vector<MaterialShading> materials_;
  std::vector<LevelShading> levels_;
  std::vector<std::uint32_t> texels_, light_;
  std::vector<float> sky_picture_;
  EmbreeDevice device_;
  EmbreeScene scene_;
  PacketScene packet_scene_{};
};

}  // namespace sim
