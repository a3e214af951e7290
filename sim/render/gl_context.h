// OpenGL context without window or display: EGL (GPU, or Mesa in software) or OSMesa (software). Private to sim/render.
// Source: EGL_EXT_platform_device, EGL_MESA_platform_surfaceless, EGL_KHR_surfaceless_context; GL/osmesa.h.
#pragma once

#define GL_GLEXT_PROTOTYPES  // for the functions' types; none is linked
#include <GL/glcorearb.h>

#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace sim {

// clang-format off
#define VOBENCH_GL_FUNCTIONS(X) \
  X(AttachShader) X(BindFramebuffer) X(BindTextureUnit) X(BindVertexArray) X(BlendFunc) \
  X(CheckNamedFramebufferStatus) X(ClearNamedFramebufferfv) X(ClearNamedFramebufferiv) X(ClipControl) \
  X(CompileShader) X(CreateBuffers) X(CreateFramebuffers) X(CreateProgram) X(CreateShader) X(CreateTextures) \
  X(CreateVertexArrays) X(DeleteBuffers) X(DeleteFramebuffers) X(DeleteProgram) X(DeleteShader) X(DeleteTextures) \
  X(DeleteVertexArrays) X(DepthFunc) X(Disable) X(DrawArrays) X(DrawElements) X(Enable) X(EnableVertexArrayAttrib) \
  X(GetError) X(GetIntegerv) X(GetProgramInfoLog) X(GetProgramiv) X(GetShaderInfoLog) X(GetShaderiv) \
  X(GetUniformLocation) X(LinkProgram) X(NamedBufferStorage) X(NamedBufferSubData) X(NamedFramebufferDrawBuffer) \
  X(NamedFramebufferReadBuffer) X(NamedFramebufferTexture) X(NamedFramebufferTextureLayer) X(PixelStorei) \
  X(ReadPixels) X(Scissor) X(ShaderSource) X(TextureBuffer) X(TextureParameteri) X(TextureStorage2D) \
  X(TextureStorage3D) X(TextureSubImage2D) X(Uniform1f) X(Uniform1i) X(Uniform2f) X(Uniform2i) X(Uniform3f) \
  X(UniformMatrix3fv) X(UniformMatrix4fv) X(UseProgram) X(VertexArrayAttribBinding) X(VertexArrayAttribFormat) \
  X(VertexArrayElementBuffer) X(VertexArrayVertexBuffer) X(Viewport)
// clang-format on

// The OpenGL functions that the rasteriser calls, of one context.
struct GlApi {
#define VOBENCH_GL_MEMBER(name) decltype(&gl##name) name = nullptr;
  VOBENCH_GL_FUNCTIONS(VOBENCH_GL_MEMBER)
#undef VOBENCH_GL_MEMBER

  // Fills the table; returns the names of missing functions. `find`: (const char* name) -> pointer to the function.
  template <class Find>
  std::vector<std::string> Load(const Find& find) {
    std::vector<std::string> missing;
#define VOBENCH_GL_LOAD(name)                                  \
  (name) = reinterpret_cast<decltype(name)>(find("gl" #name)); \
  if ((name) == nullptr) missing.emplace_back("gl" #name);
    VOBENCH_GL_FUNCTIONS(VOBENCH_GL_LOAD)
#undef VOBENCH_GL_LOAD
    return missing;
  }
};

#undef VOBENCH_GL_FUNCTIONS

enum class GlPlatform;  // sim/render/rasteriser.h

// libEGL and libOSMesa are loaded at run time, on demand: neither is needed to build or to run the rest.
class GlContext {
 public:
  virtual ~GlContext() = default;

  // Makes the context current in the calling thread for its lifetime; other threads wait.
  class Current {
   public:
    explicit Current(GlContext& context);
    ~Current();
    Current(const Current&) = delete;
    Current& operator=(const Current&) = delete;

   private:
    GlContext& context_;
    std::lock_guard<std::mutex> lock_;
  };

  // Fills gl(). Throws std::runtime_error naming what is missing.
  void LoadFunctions();
  const GlApi& gl() const { return gl_; }  // to be called only while Current

 protected:
  virtual void MakeCurrent() = 0;  // throws std::runtime_error
  virtual void Release() noexcept = 0;
  virtual void* Find(const char* function) const = 0;

 private:
  GlApi gl_;
  std::mutex mutex_;
};

// OpenGL 4.5 core. Throws std::runtime_error with the reason of failure for each platform that was tried.
std::unique_ptr<GlContext> MakeGlContext(GlPlatform platform);

}  // namespace sim
