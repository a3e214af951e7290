#include "sim/render/raster_scene.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <limits>

#include "sim/render/ray_scene.h"

namespace sim {
namespace {

float Bits(int number) { return std::bit_cast<float>(number); }

bool HasColors(const Scene& scene) {
  const auto any = [](const std::vector<Mesh>& meshes) {
    return std::any_of(meshes.begin(), meshes.end(), [](const Mesh& mesh) { return !mesh.colors.empty(); });
  };
  return any(scene.meshes) || std::any_of(scene.objects.begin(), scene.objects.end(),
                                          [&](const MovingObject& object) { return any(object.meshes); });
}

glm::vec4 Row(const float (&v)[3], float w) { return {v[0], v[1], v[2], w}; }

}  // namespace

RasterScene::RasterScene(const GlApi& gl, const Scene& scene) : gl_(gl) {
  CheckScene(scene);
  AppendTextures(scene);
  AppendMeshes(scene);
  position_buffer_ = MakeBuffer(gl, positions_);
  corner_buffer_ = MakeBuffer(gl, corners_);
  vertex_array_ = MakeVertexArray(gl);
  const GLuint array = vertex_array_.id();
  gl.VertexArrayVertexBuffer(array, 0, position_buffer_.id(), 0, sizeof(glm::vec3));
  gl.VertexArrayElementBuffer(array, corner_buffer_.id());
  gl.EnableVertexArrayAttrib(array, 0);
  gl.VertexArrayAttribFormat(array, 0, 3, GL_FLOAT, GL_FALSE, 0);
  gl.VertexArrayAttribBinding(array, 0, 0);
  CheckGl(gl, "loading the scene");
}

void RasterScene::Draw(const Program& triangles, const GlObject& target, const glm::ivec2& size,
                       const glm::vec3& origin, const glm::mat4& clip) const {
  gl_.BindFramebuffer(GL_FRAMEBUFFER, target.id());
  gl_.Viewport(0, 0, size.x, size.y);
  gl_.Scissor(0, 0, size.x, size.y);
  gl_.Enable(GL_DEPTH_TEST);
  const float far = 0.0f;
  gl_.ClearNamedFramebufferfv(target.id(), GL_DEPTH, 0, &far);
  triangles.Use();
  triangles.Set("origin", origin);
  triangles.Set("clip_from_world", clip);
  gl_.BindVertexArray(vertex_array_.id());
  gl_.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * corners_.size()), GL_UNSIGNED_INT, nullptr);
}

void RasterScene::AppendTextures(const Scene& scene) {
  std::vector<glm::ivec4> levels;
  std::vector<std::uint32_t> texels;
  std::vector<int> first_level;
  for (const Texture& texture : scene.textures) {
    first_level.push_back(static_cast<int>(levels.size()));
    for (const TextureLevel& level : texture.levels()) {
      levels.emplace_back(level.width, level.height, static_cast<int>(texels.size()), 0);
      for (int y = 0; y < level.height; ++y) {
        const std::uint32_t* row = &texture.texels()[level.RowBegin(y)];
        texels.insert(texels.end(), row, row + level.width);
      }
    }
  }
  std::vector<glm::vec4> materials;
  for (const Material& m : scene.materials) {
    const auto texture = static_cast<std::size_t>(m.texture);
    const bool has_texture = m.texture >= 0;
    materials.emplace_back(m.base_color, Bits(has_texture ? first_level[texture] : 0));
    // Of an emissive picture the mean, which is the last level.
    glm::vec3 emission = m.emission;
    if (m.emission_texture >= 0) {
      const Texture& picture = scene.textures[static_cast<std::size_t>(m.emission_texture)];
      emission *= picture.Texel(static_cast<int>(picture.levels().size()) - 1, 0, 0);
    }
    materials.emplace_back(emission, Bits(has_texture ? static_cast<int>(scene.textures[texture].levels().size()) : 0));
  }
  texels_ = BufferTexture(gl_, GL_R32UI, texels, "the textures");
  levels_ = BufferTexture(gl_, GL_RGBA32I, levels, "the textures' levels");
  materials_ = BufferTexture(gl_, GL_RGBA32F, materials, "the materials");
}

void RasterScene::Move(double t_s) {
  if (!moves() || moved_to_s_ == t_s) return;
  low_ = still_low_, high_ = still_high_;
  for (const Part& part : objects_) {
    const Pose pose = part.motion->At(t_s).pose;
    std::vector<glm::vec3> positions;
    for (std::size_t i = part.first_position; i < part.end_position; ++i) {
      const glm::vec3 p(pose.q_WC * glm::dvec3(positions_[i]) + pose.p_WC);
      low_ = glm::min(low_, p), high_ = glm::max(high_, p);
      positions.push_back(p);
    }
    std::vector<glm::vec4> table = part.table;
    const auto row = static_cast<std::size_t>(texels_per_triangle_);
    for (std::size_t i = 0; i < table.size(); ++i) {
      const std::size_t which = i % row;  // the place of corner 0, then vectors; texture coordinates and colours stay
      if (which > 5) continue;
      const glm::dvec3 turned = pose.q_WC * glm::dvec3(table[i]) + (which == 0 ? pose.p_WC : glm::dvec3(0.0));
      table[i] = glm::vec4(glm::vec3(turned), table[i].w);
    }
    const auto at = [](std::size_t bytes) { return static_cast<GLsizeiptr>(bytes); };
    gl_.NamedBufferSubData(position_buffer_.id(), at(part.first_position * sizeof(glm::vec3)),
                           at(positions.size() * sizeof(glm::vec3)), positions.data());
    gl_.NamedBufferSubData(triangles_.buffer.id(), at(part.first_triangle * row * sizeof(glm::vec4)),
                           at(table.size() * sizeof(glm::vec4)), table.data());
  }
  moved_to_s_ = t_s;
}

void RasterScene::AppendMeshes(const Scene& scene) {
  texels_per_triangle_ = HasColors(scene) ? 10 : 7;
  std::vector<glm::vec4> table;
  for (const Mesh& mesh : scene.meshes) AppendMesh(scene, mesh, table);
  low_ = glm::vec3(std::numeric_limits<float>::infinity());
  high_ = -low_;
  for (const glm::vec3& p : positions_) low_ = glm::min(low_, p), high_ = glm::max(high_, p);
  if (positions_.empty()) low_ = high_ = glm::vec3(0.0f);
  still_low_ = low_, still_high_ = high_;
  for (const MovingObject& object : scene.objects) {
    Part part;
    part.motion = object.motion;
    part.first_position = positions_.size();
    part.first_triangle = corners_.size();
    for (const Mesh& mesh : object.meshes) AppendMesh(scene, mesh, part.table);
    part.end_position = positions_.size();
    table.insert(table.end(), part.table.begin(), part.table.end());
    objects_.push_back(std::move(part));
  }
  triangles_ = BufferTexture(gl_, GL_RGBA32F, table, "the triangles");
}

void RasterScene::AppendMesh(const Scene& scene, const Mesh& mesh, std::vector<glm::vec4>& table) {
  const bool has_colors = texels_per_triangle_ > 7;
  const auto first = static_cast<std::uint32_t>(positions_.size());
  positions_.insert(positions_.end(), mesh.positions.begin(), mesh.positions.end());
  const int texture = scene.materials[static_cast<std::size_t>(mesh.material)].texture;
  for (const glm::uvec3& t : mesh.triangles) {
    corners_.push_back(first + t);
    const OverTriangle<3> p = Over(mesh.positions, t);
    const glm::dvec3 cross = glm::cross(glm::dvec3(glm::make_vec3(p.du)), glm::dvec3(glm::make_vec3(p.dv)));
    const double area = glm::length(cross);
    OverTriangle<3> normal{};
    if (mesh.normals.empty()) {
      Store(normal.first, area > 0 ? cross / area : glm::dvec3(0, 0, 1));
    } else {
      normal = Over(mesh.normals, t);
    }
    OverTriangle<2> uv{};
    double texels_per_metre = 0.0;
    if (texture >= 0) {
      const Texture& picture = scene.textures[static_cast<std::size_t>(texture)];
      uv = UvsOver(mesh, t);
      const double texels =
          std::abs(double{uv.du[0]} * uv.dv[1] - double{uv.du[1]} * uv.dv[0]) * picture.width() * picture.height();
      texels_per_metre = area > 0 ? std::sqrt(texels / area) : 0.0;
    }
    table.push_back(Row(p.first, Bits(mesh.material)));
    table.push_back(Row(p.du, static_cast<float>(texels_per_metre)));
    table.push_back(Row(p.dv, 0.0f));
    table.push_back(Row(normal.first, uv.first[0]));
    table.push_back(Row(normal.du, uv.first[1]));
    table.push_back(Row(normal.dv, 0.0f));
    table.emplace_back(uv.du[0], uv.du[1], uv.dv[0], uv.dv[1]);
    if (!has_colors) continue;
    const OverTriangle<3> color = ColorsOver(mesh, t);
    for (const auto* row : {&color.first, &color.du, &color.dv}) table.push_back(Row(*row, 0.0f));
  }
}

}  // namespace sim
