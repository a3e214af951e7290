#include "sim/render/gl_objects.h"

#include <algorithm>
#include <stdexcept>

namespace sim {
namespace {

// Throws with the log of the compiler or linker for `id` unless its `status` is good.
template <class Get, class GetLog>
void CheckBuilt(GLuint id, GLenum status, const Get& get, const GetLog& get_log, const std::string& what) {
  GLint good = 0, length = 0;
  get(id, status, &good);
  if (good != 0) return;
  get(id, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
  get_log(id, length, nullptr, log.data());
  throw std::runtime_error("rasteriser: " + what + ": " + log);
}

GlObject Compile(const GlApi& gl, const std::string& name, GLenum kind, const std::string& source) {
  GlObject shader(gl, gl.CreateShader(kind), [](const GlApi& api, GLuint id) { api.DeleteShader(id); });
  const char* text = source.c_str();
  gl.ShaderSource(shader.id(), 1, &text, nullptr);
  gl.CompileShader(shader.id());
  CheckBuilt(shader.id(), GL_COMPILE_STATUS, gl.GetShaderiv, gl.GetShaderInfoLog, "shader " + name);
  return shader;
}

}  // namespace

void CheckGl(const GlApi& gl, const std::string& what) {
  const GLenum error = gl.GetError();
  if (error == GL_NO_ERROR) return;
  while (gl.GetError() != GL_NO_ERROR) {
  }
  throw std::runtime_error("rasteriser: " + what + ": OpenGL error " + std::to_string(error) +
                           (error == GL_OUT_OF_MEMORY ? " (out of memory)" : ""));
}

GlObject MakeBuffer(const GlApi& gl, std::size_t bytes, const void* data) {
  GLuint id = 0;
  gl.CreateBuffers(1, &id);
  GlObject buffer(gl, id, [](const GlApi& api, GLuint b) { api.DeleteBuffers(1, &b); });
  const std::vector<char> nothing(16);  // a buffer has a size
  gl.NamedBufferStorage(id, static_cast<GLsizeiptr>(std::max(bytes, nothing.size())), nullptr, GL_DYNAMIC_STORAGE_BIT);
  if (bytes > 0) gl.NamedBufferSubData(id, 0, static_cast<GLsizeiptr>(bytes), data);
  return buffer;
}

GlObject NewTexture(const GlApi& gl, GLenum target) {
  GLuint id = 0;
  gl.CreateTextures(target, 1, &id);
  return {gl, id, [](const GlApi& api, GLuint t) { api.DeleteTextures(1, &t); }};
}

GlObject MakeTexture(const GlApi& gl, GLenum format, int width, int height) {
  GlObject texture = NewTexture(gl, GL_TEXTURE_2D);
  gl.TextureStorage2D(texture.id(), 1, format, width, height);
  gl.TextureParameteri(texture.id(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  gl.TextureParameteri(texture.id(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return texture;
}

BufferTexture::BufferTexture(const GlApi& gl, GLenum format, std::size_t texels, std::size_t bytes, const void* data,
                             const std::string& what) {
  GLint most = 0;
  gl.GetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
  if (texels > static_cast<std::size_t>(most)) {
    throw std::invalid_argument("rasteriser: " + what + ": " + std::to_string(texels) +
                                " texels, but this OpenGL has " + std::to_string(most) +
                                " in a buffer at most; the ray tracer has no such limit");
  }
  buffer = MakeBuffer(gl, bytes, data);
  texture = NewTexture(gl, GL_TEXTURE_BUFFER);
  gl.TextureBuffer(texture.id(), format, buffer.id());
}

GlObject MakeVertexArray(const GlApi& gl) {
  GLuint id = 0;
  gl.CreateVertexArrays(1, &id);
  return {gl, id, [](const GlApi& api, GLuint a) { api.DeleteVertexArrays(1, &a); }};
}

GlObject MakeFramebuffer(const GlApi& gl) {
  GLuint id = 0;
  gl.CreateFramebuffers(1, &id);
  return {gl, id, [](const GlApi& api, GLuint f) { api.DeleteFramebuffers(1, &f); }};
}

Program::Program(const GlApi& gl, const std::string& name, const std::string& vertex, const std::string& fragment)
    : gl_(&gl), program_(gl, gl.CreateProgram(), [](const GlApi& api, GLuint id) { api.DeleteProgram(id); }) {
  const GlObject first = Compile(gl, name + " (vertex)", GL_VERTEX_SHADER, vertex),
                 second = Compile(gl, name + " (fragment)", GL_FRAGMENT_SHADER, fragment);
  gl.AttachShader(program_.id(), first.id());
  gl.AttachShader(program_.id(), second.id());
  gl.LinkProgram(program_.id());
  CheckBuilt(program_.id(), GL_LINK_STATUS, gl.GetProgramiv, gl.GetProgramInfoLog, "shaders " + name + " do not link");
}

void Program::Use() const { gl_->UseProgram(program_.id()); }
GLint Program::Find(const char* name) const { return gl_->GetUniformLocation(program_.id(), name); }
void Program::Set(const char* name, int v) const { gl_->Uniform1i(Find(name), v); }
void Program::Set(const char* name, float v) const { gl_->Uniform1f(Find(name), v); }
void Program::Set(const char* name, const glm::vec2& v) const { gl_->Uniform2f(Find(name), v.x, v.y); }
void Program::Set(const char* name, const glm::ivec2& v) const { gl_->Uniform2i(Find(name), v.x, v.y); }
void Program::Set(const char* name, const glm::vec3& v) const { gl_->Uniform3f(Find(name), v.x, v.y, v.z); }
void Program::Set(const char* name, const glm::mat3& v) const {
  gl_->UniformMatrix3fv(Find(name), 1, GL_FALSE, &v[0][0]);
}
void Program::Set(const char* name, const glm::mat4& v) const {
  gl_->UniformMatrix4fv(Find(name), 1, GL_FALSE, &v[0][0]);
}

}  // namespace sim
