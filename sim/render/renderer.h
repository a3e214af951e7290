// Renderer: the radiance that a camera collects during an exposure.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/motion/pose.h"
#include "sim/motion/trajectory.h"
#include "sim/sensor/camera.h"
#include "sim/sensor/exposure.h"
#include "sim/sensor/image.h"

namespace sim {

class SurfaceTracer;

// Results are functions of the arguments alone. Concurrent calls are allowed.
class Renderer {
 public:
  virtual ~Renderer() = default;

  // The mean linear radiance that each pixel collects while the camera moves along `motion`, objects move along theirs,
  // and its row is exposed.
  // Each time sample is an equal part of the exposure; in it a pixel looks at a moment and through a point of its
  // square of its own, keyed by (key, pixel, sample), so that the exposure also antialiases. `out` is resized. Throws
  // std::invalid_argument listing the Problems of the shutter.
  virtual void Expose(const Camera& camera, const Trajectory& motion, const Exposure& exposure, std::uint64_t key,
                      RadianceImage& out) const = 0;

  // Exact queries of the geometry, as long as the renderer lives; null: this renderer has none, a ray tracer of the
  // same scene is needed.
  virtual const SurfaceTracer* surfaces() const { return nullptr; }
};

}  // namespace sim
