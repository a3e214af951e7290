// Platform of an OpenGL context.
#pragma once

namespace sim {

enum class GlPlatform {
  automatic,  // the first of those below that works
  egl,        // libEGL.so.1, on a device that it lists (GPUs first) or surfaceless; no display
  osmesa      // libOSMesa.so: Mesa in software. No longer a part of Mesa since 25.1
};

}  // namespace sim
