// Scene tables of the rasteriser, in the form that the shaders read. Private to sim/render.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "sim/motion/pose.h"
#include "sim/render/gl_objects.h"
#include "sim/world/scene.h"

namespace sim {

// Tables of texels, by number:
//   triangles  7, or 10 where a mesh has colours: (corner 0, material), (corner 1 - corner 0, texels per metre),
//              (corner 2 - corner 0, -), (normal of corner 0, u), (difference to corner 1, v), (to corner 2, -),
//              (differences of u, v to corner 1 and to corner 2), colour of corner 0, differences to corners 1 and 2.
//   materials  2: (base colour, first level), (emission, number of levels, 0 without a texture). Whole numbers are
//              stored by their bits.
//   levels     1: width, height, first texel; of all textures' mip chains
//   texels     as in sim/world/texture.h
class RasterScene {
 public:
  // Throws std::invalid_argument for a scene with an index out of range and for one that is larger than the context's
  // tables, std::runtime_error when it runs out of memory.
  RasterScene(const GlApi& gl, const Scene& scene);

  // Draws all triangles into the target's first `size` pixels, by depth, cleared first. clip: of positions less
  // `origin`.
  void Draw(const Program& triangles, const GlObject& target, const glm::ivec2& size, const glm::vec3& origin,
            const glm::mat4& clip) const;

  bool moves() const { return !objects_.empty(); }
  // Places the objects at a time; until the first call they are not drawn.
  void Move(double t_s);

  GLuint triangles() const { return triangles_.texture.id(); }
  GLuint materials() const { return materials_.texture.id(); }
  GLuint levels() const { return levels_.texture.id(); }
  GLuint texels() const { return texels_.texture.id(); }
  int texels_per_triangle() const { return texels_per_triangle_; }

  // Bounding box in W, with the objects in place; a point where the scene is empty.
  const glm::vec3& low() const { return low_; }
  const glm::vec3& high() const { return high_; }

 private:
  // An object's part of the buffers, and its part of the table with all vectors in O.
  struct Part {
    std::shared_ptr<const Trajectory> motion;
    std::size_t first_position = 0, end_position = 0, first_triangle = 0;
    std::vector<glm::vec4> table;
  };

  void AppendTextures(const Scene& scene);
  void AppendMeshes(const Scene& scene);
  void AppendMesh(const Scene& scene, const Mesh& mesh, std::vector<glm::vec4>& table);

  const GlApi& gl_;
  std::vector<glm::vec3> positions_;
  std::vector<glm::uvec3> corners_;
  glm::vec3 low_{0.0f}, high_{0.0f}, still_low_{0.0f}, still_high_{0.0f};
  std::vector<Part> objects_;
  std::optional<double> moved_to_s_;
  int texels_per_triangle_ = 7;
  GlObject position_buffer_, corner_buffer_, vertex_array_;
  BufferTexture triangles_, materials_, levels_, texels_;
};

}  // namespace sim
