// Purpose: the one interface between what a camera is shown and how it is computed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/motion/pose.h"
#include "sim/render/radiance_image.h"
#include "sim/sensor/camera.h"

namespace sim {

// Results are functions of the arguments alone: not of the number of threads, of earlier calls, or of calls at the same
// time from other threads, all of which are allowed.
class Renderer {
 public:
  virtual ~Renderer() = default;

  // The mean linear radiance that each pixel collects while the camera takes the poses `time_samples` (T_WC), each with
  // the same weight. Each time sample looks through its own point of each pixel's square, keyed by (key, pixel,
  // sample), so that the exposure also antialiases. `out` is resized. Throws std::invalid_argument when there is no
  // time sample.
  virtual void Expose(const Camera& camera, std::span<const Pose> time_samples, std::uint64_t key,
                      RadianceImage& out) const = 0;

  // Z in the camera frame [m] of what is seen through each pixel's centre, rows from the top; 0 = nothing. `out` is
  // resized.
  virtual void Depth(const Camera& camera, const Pose& pose, std::vector<float>& out) const = 0;
};

}  // namespace sim
