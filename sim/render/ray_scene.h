// Purpose: a scene in the form in which rays meet it: Embree's tree, and tables for shading. Private to sim/render.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <type_traits>
#include <vector>

#include "sim/render/packet.h"
#include "sim/world/scene.h"

namespace sim {

struct EmbreeRelease {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using EmbreeDevice = std::unique_ptr<std::remove_pointer_t<RTCDevice>, EmbreeRelease>;
using EmbreeScene = std::unique_ptr<std::remove_pointer_t<RTCScene>, EmbreeRelease>;

// All meshes are one Embree geometry, so that a hit's primitive number is the index into every per-triangle table.
class RayScene {
 public:
  // Throws std::invalid_argument for a scene with an index out of range, std::runtime_error when Embree fails.
  explicit RayScene(const Scene& scene);

  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  const PacketScene& packet_scene() const { return packet_scene_; }
  RTCScene embree() const { return scene_.get(); }

  // Corner 0 ... 2 of a triangle, in W.
  const glm::vec3& Corner(std::uint32_t triangle, int corner) const { return positions_[triangles_[triangle][corner]]; }
  // Index in Scene::meshes of the mesh that a triangle is of.
  std::uint32_t MeshOf(std::uint32_t triangle) const;

 private:
  void AppendTextures(const Scene& scene);
  void AppendMesh(const Scene& scene, const Mesh& mesh, bool any_colors);
  void Build();

  std::vector<glm::vec3> positions_;
  std::vector<glm::uvec3> triangles_;
  std::vector<std::uint32_t> first_triangle_;  // of each mesh
  std::vector<TriangleShading> shading_;
  std::vector<TriangleColor> colors_;
  std::vector<MaterialShading> materials_;
  std::vector<LevelShading> levels_;
  std::vector<std::uint32_t> texels_;
  EmbreeDevice device_;
  EmbreeScene scene_;
  PacketScene packet_scene_{};
};

}  // namespace sim
