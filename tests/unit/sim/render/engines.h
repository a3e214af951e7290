// Tests parameterised by renderer: ray tracer, rasteriser on EGL, rasteriser on OSMesa.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>
#include <string>

#include "sim/render/gl_context.h"
#include "sim/render/rasteriser.h"
#include "tests/unit/sim/render/worlds.h"

namespace sim::test {

struct EngineUnderTest {
  const char* name;
  bool is_rasteriser;
  GlPlatform platform;
};

inline void PrintTo(const EngineUnderTest& engine, std::ostream* out) { *out << engine.name; }

constexpr EngineUnderTest kRayTracer{"ray_tracer", false, GlPlatform::automatic};
constexpr EngineUnderTest kEgl{"egl", true, GlPlatform::egl};
constexpr EngineUnderTest kOsmesa{"osmesa", true, GlPlatform::osmesa};

inline std::string EngineName(const testing::TestParamInfo<EngineUnderTest>& info) { return info.param.name; }

// Reason for the lack of the renderer's OpenGL platform; empty where it is available.
inline std::string Missing(const EngineUnderTest& engine) {
  try {
    if (engine.is_rasteriser) MakeGlContext(engine.platform);
    return "";
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

inline std::unique_ptr<Renderer> MakeEngine(const EngineUnderTest& engine, const Scene& scene,
                                            const RayTracerOptions& options = Centred()) {
  if (!engine.is_rasteriser) return MakeRayTracer(scene, options);
  RasteriserOptions same;
  same.platform = engine.platform;
  same.rays_per_time_sample = options.rays_per_time_sample;
  same.jitter = options.jitter;
  return MakeRasteriser(scene, same);
}

// A test of each renderer; skipped where a rasteriser's OpenGL is missing.
class EngineTest : public testing::TestWithParam<EngineUnderTest> {
 protected:
  void SetUp() override {
    const std::string missing = Missing(GetParam());
    if (!missing.empty()) GTEST_SKIP() << missing;
  }
  RadianceImage Render(const Scene& scene, const Camera& camera, const Pose& pose,
                       const RayTracerOptions& options = Centred()) const {
    RadianceImage image;
    MakeEngine(GetParam(), scene, options)->Expose(camera, SteadyMotion(pose), Exposure{}, 1, image);
    return image;
  }
};

}  // namespace sim::test
