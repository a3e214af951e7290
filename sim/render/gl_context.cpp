#include "sim/render/gl_context.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/osmesa.h>
#include <dlfcn.h>

#include <array>
#include <stdexcept>
#include <string_view>

#include "sim/render/rasteriser.h"
#include "tools/base/text.h"

namespace sim {
namespace {

// Shared library that is never closed, since threads that it has started may still run.
class Library {
 public:
  explicit Library(std::initializer_list<const char*> names) {
    for (const char* name : names) {
      if ((handle_ = dlopen(name, RTLD_NOW | RTLD_LOCAL)) != nullptr) return;
    }
    const char* reason = dlerror();
    throw std::runtime_error(reason != nullptr ? reason : "cannot be opened");
  }
  template <class Function>
  Function* Get(const char* name) const {
    auto* function = reinterpret_cast<Function*>(dlsym(handle_, name));
    if (function == nullptr) throw std::runtime_error(std::string("has no ") + name);
    return function;
  }

 private:
  void* handle_ = nullptr;
};

#define VOBENCH_GET(function) library_.Get<decltype(function)>(#function)

class EglContext final : public GlContext {
 public:
  EglContext() : library_({"libEGL.so.1"}), find_(VOBENCH_GET(eglGetProcAddress)) {
    std::vector<std::string> reasons;
    for (const EGLDisplay display : Displays()) {
      if (Open(display, reasons)) break;
    }
    if (context_ == EGL_NO_CONTEXT)
      throw std::runtime_error("no device or surfaceless display serves (" + base::Join(reasons, ", ") + ")");
  }
  ~EglContext() override {
    if (context_ != EGL_NO_CONTEXT) VOBENCH_GET(eglDestroyContext)(display_, context_);
  }

 protected:
  void MakeCurrent() override {
    if (VOBENCH_GET(eglBindAPI)(EGL_OPENGL_API) != EGL_TRUE ||
        make_current_(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) != EGL_TRUE) {
      throw std::runtime_error("EGL: the context cannot be made current, error " + ErrorCode());
    }
  }
  void Release() noexcept override { make_current_(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT); }
  void* Find(const char* function) const override { return reinterpret_cast<void*>(find_(function)); }

 private:
  std::string ErrorCode() const { return std::to_string(VOBENCH_GET(eglGetError)()); }

  // GPUs first: the vendors' libraries list their devices in their own order, Mesa its software last.
  std::vector<EGLDisplay> Displays() const {
    std::vector<EGLDisplay> displays;
    const auto get = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(find_("eglGetPlatformDisplayEXT"));
    const auto query = reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(find_("eglQueryDevicesEXT"));
    const char* known = VOBENCH_GET(eglQueryString)(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    const std::string_view extensions = known != nullptr ? known : "";
    if (get == nullptr) return displays;
    std::array<EGLDeviceEXT, 32> devices{};
    EGLint count = 0;
    if (query != nullptr && extensions.find("EGL_EXT_platform_device") != std::string_view::npos &&
        query(static_cast<EGLint>(devices.size()), devices.data(), &count) == EGL_TRUE) {
      for (EGLint i = 0; i < count; ++i) {
        displays.push_back(get(EGL_PLATFORM_DEVICE_EXT, devices[static_cast<std::size_t>(i)], nullptr));
      }
    }
    if (extensions.find("EGL_MESA_platform_surfaceless") != std::string_view::npos) {
      displays.push_back(get(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr));
    }
    return displays;
  }

  // A display is the process's: it is never terminated, since other code may use it.
  bool Open(EGLDisplay display, std::vector<std::string>& reasons) {
    if (display == EGL_NO_DISPLAY || VOBENCH_GET(eglInitialize)(display, nullptr, nullptr) != EGL_TRUE) {
      reasons.push_back("a display does not start");
      return false;
    }
    if (VOBENCH_GET(eglBindAPI)(EGL_OPENGL_API) != EGL_TRUE) {
      reasons.push_back("a display has no OpenGL");
      return false;
    }
    const std::array<EGLint, 7> attributes = {
        EGL_CONTEXT_MAJOR_VERSION,           4,       EGL_CONTEXT_MINOR_VERSION, 5, EGL_CONTEXT_OPENGL_PROFILE_MASK,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    const EGLContext context =
        VOBENCH_GET(eglCreateContext)(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
    if (context == EGL_NO_CONTEXT) {
      reasons.push_back("a display makes no OpenGL 4.5 context, error " + ErrorCode());
      return false;
    }
    display_ = display;
    context_ = context;
    make_current_ = VOBENCH_GET(eglMakeCurrent);
    return true;
  }

  Library library_;
  decltype(eglGetProcAddress)* find_;
  decltype(eglMakeCurrent)* make_current_ = nullptr;
  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
};

class MesaContext final : public GlContext {
 public:
  MesaContext()
      : library_({"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"}),
        find_(VOBENCH_GET(OSMesaGetProcAddress)),
        make_current_(VOBENCH_GET(OSMesaMakeCurrent)) {
    const std::array<int, 11> attributes = {OSMESA_FORMAT,
                                            OSMESA_RGBA,
                                            OSMESA_DEPTH_BITS,
                                            0,
                                            OSMESA_PROFILE,
                                            OSMESA_CORE_PROFILE,
                                            OSMESA_CONTEXT_MAJOR_VERSION,
                                            4,
                                            OSMESA_CONTEXT_MINOR_VERSION,
                                            5,
                                            0};
    context_ = VOBENCH_GET(OSMesaCreateContextAttribs)(attributes.data(), nullptr);
    if (context_ == nullptr) throw std::runtime_error("makes no OpenGL 4.5 context");
  }
  ~MesaContext() override { VOBENCH_GET(OSMesaDestroyContext)(context_); }

 protected:
  void MakeCurrent() override {
    if (make_current_(context_, pixel_.data(), GL_UNSIGNED_BYTE, 1, 1) != GL_TRUE) {
      throw std::runtime_error("OSMesa: the context cannot be made current");
    }
  }
  void Release() noexcept override { make_current_(nullptr, nullptr, 0, 0, 0); }
  void* Find(const char* function) const override { return reinterpret_cast<void*>(find_(function)); }

 private:
  Library library_;
  decltype(OSMesaGetProcAddress)* find_;
  decltype(OSMesaMakeCurrent)* make_current_;
  OSMesaContext context_ = nullptr;
  std::array<unsigned char, 4> pixel_{};  // OSMesa requires a window; nothing is drawn into it
};

#undef VOBENCH_GET

}  // namespace

GlContext::Current::Current(GlContext& context) : context_(context), lock_(context.mutex_) { context_.MakeCurrent(); }
GlContext::Current::~Current() { context_.Release(); }

void GlContext::LoadFunctions() {
  const Current current(*this);
  const std::vector<std::string> missing = gl_.Load([this](const char* name) { return Find(name); });
  if (!missing.empty()) throw std::runtime_error("its OpenGL lacks " + base::Join(missing, ", "));
}

std::unique_ptr<GlContext> MakeGlContext(GlPlatform platform) {
  std::vector<std::string> reasons;
  std::unique_ptr<GlContext> made;
  const auto attempt = [&](const char* name, auto make) {
    if (made != nullptr) return;
    try {
      auto context = make();
      context->LoadFunctions();
      made = std::move(context);
    } catch (const std::runtime_error& error) {
      reasons.push_back(name + std::string(": ") + error.what());
    }
  };
  if (platform != GlPlatform::osmesa) attempt("EGL", [] { return std::make_unique<EglContext>(); });
  if (platform != GlPlatform::egl) attempt("OSMesa", [] { return std::make_unique<MesaContext>(); });
  if (made == nullptr)
    throw std::runtime_error("rasteriser: no OpenGL without a display. " + base::Join(reasons, "; "));
  return made;
}

}  // namespace sim
