// RAII wrappers of OpenGL objects: buffers, textures, framebuffers, programs. Private to sim/render. The context must
// be current for all of it, destructors included. Only Program throws by itself: CheckGl checks for OpenGL errors.
#pragma once

#include <cstddef>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <utility>
#include <vector>

#include "sim/render/gl_context.h"

namespace sim {

// Throws std::runtime_error naming `what` on an OpenGL error since the last check.
void CheckGl(const GlApi& gl, const std::string& what);

class GlObject {
 public:
  using Delete = void (*)(const GlApi&, GLuint);
  GlObject() = default;
  GlObject(const GlApi& gl, GLuint id, Delete destroy) : gl_(&gl), id_(id), delete_(destroy) {}
  ~GlObject() { Free(); }
  GlObject(GlObject&& other) noexcept { *this = std::move(other); }
  GlObject& operator=(GlObject&& other) noexcept {
    if (this == &other) return *this;
    Free();
    gl_ = other.gl_, delete_ = other.delete_, id_ = std::exchange(other.id_, 0);
    return *this;
  }
  GLuint id() const { return id_; }
  explicit operator bool() const { return id_ != 0; }

 private:
  void Free() {
    if (id_ != 0) delete_(*gl_, id_);
    id_ = 0;
  }
  const GlApi* gl_ = nullptr;
  GLuint id_ = 0;
  Delete delete_ = nullptr;
};

// Without storage; target: GL_TEXTURE_...
GlObject NewTexture(const GlApi& gl, GLenum target);

GlObject MakeBuffer(const GlApi& gl, std::size_t bytes, const void* data);
template <class T>
GlObject MakeBuffer(const GlApi& gl, const std::vector<T>& data) {
  return MakeBuffer(gl, data.size() * sizeof(T), data.data());
}

// One level, nearest texel, nothing beyond its border.
GlObject MakeTexture(const GlApi& gl, GLenum format, int width, int height);

// Buffer texture: a one-dimensional array of texels, fetched by index.
struct BufferTexture {
  GlObject buffer, texture;
  BufferTexture() = default;
  // Each of `data` is `texels_each` texels. Throws std::invalid_argument naming `what` for more than the context's
  // limit.
  template <class T>
  BufferTexture(const GlApi& gl, GLenum format, const std::vector<T>& data, const std::string& what,
                std::size_t texels_each = 1)
      : BufferTexture(gl, format, texels_each * data.size(), data.size() * sizeof(T), data.data(), what) {}

 private:
  BufferTexture(const GlApi& gl, GLenum format, std::size_t texels, std::size_t bytes, const void* data,
                const std::string& what);
};

GlObject MakeVertexArray(const GlApi& gl);
GlObject MakeFramebuffer(const GlApi& gl);

// A vertex and a fragment shader. Set() acts on the program in use, which Use() selects.
class Program {
 public:
  Program() = default;
  // Throws std::runtime_error with the compiler's messages.
  Program(const GlApi& gl, const std::string& name, const std::string& vertex, const std::string& fragment);

  void Use() const;
  void Set(const char* name, int value) const;
  void Set(const char* name, float value) const;
  void Set(const char* name, const glm::vec2& value) const;
  void Set(const char* name, const glm::ivec2& value) const;
  void Set(const char* name, const glm::vec3& value) const;
  void Set(const char* name, const glm::mat3& value) const;
  void Set(const char* name, const glm::mat4& value) const;

 private:
  GLint Find(const char* name) const;
  const GlApi* gl_ = nullptr;
  GlObject program_;
};

}  // namespace sim
