// OpenGL context without window or display: EGL (GPU, or Mesa in software) or OSMesa (software). Private to sim/render.
// Source: EGL_EXT_platform_device, EGL_MESA_platform_surfaceless, EGL_KHR_surfaceless_context; GL/osmesa.h.
#pragma once

#include <memory>
#include <mutex>

#include "sim/render/gl_api.h"
#include "sim/render/gl_platform.h"

namespace sim {

// libEGL and libOSMesa are opened when they are asked for: a machine without either builds and runs all the rest.
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

  const GlApi& gl() const { return gl_; }  // to be called only while Current

 protected:
  virtual void MakeCurrent() = 0;  // throws std::runtime_error
  virtual void Release() noexcept = 0;
  virtual void* Find(const char* function) const = 0;
  // For the end of the constructors: fills gl_. Throws std::runtime_error naming what is missing.
  void LoadFunctions();

 private:
  GlApi gl_;
  std::mutex mutex_;
};

// OpenGL 4.5 core. Throws std::runtime_error that says, for each platform that was tried, why it does not serve.
std::unique_ptr<GlContext> MakeGlContext(GlPlatform platform);

}  // namespace sim
