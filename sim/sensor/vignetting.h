// Vignetting: the fall-off of irradiance towards the corners of the image.
#pragma once

#include <string>
#include <vector>

#include "sim/sensor/camera.h"
#include "sim/sensor/description.h"
#include "sim/sensor/image.h"

namespace sim {

// The factor of a pixel: cos^4 of its ray's angle from the optical axis (where natural), times
// 1 + v2 r^2 + v4 r^4 + v6 r^6.
class Vignetting {
 public:
  // Throws std::invalid_argument where the factor is negative somewhere in the image.
  Vignetting(const OpticsParams& optics, const Camera& camera);

  double Factor(double u, double v) const;
  // Multiplies every pixel by its factor.
  void Apply(RadianceImage& image) const;

 private:
  OpticsParams optics_;
  Camera camera_;
  std::vector<float> factors_;  // by pixel; empty: 1 everywhere
};

}  // namespace sim
