#include "sim/sensor/vignetting.h"

#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <stdexcept>

namespace sim {

Vignetting::Vignetting(const OpticsParams& optics, const Camera& camera) : optics_(optics), camera_(camera) {
  const bool polynomial = optics.vignetting_2 != 0 || optics.vignetting_4 != 0 || optics.vignetting_6 != 0;
  if (!polynomial && !optics.natural_vignetting) return;
  factors_.reserve(static_cast<std::size_t>(camera.width()) * static_cast<std::size_t>(camera.height()));
  for (int v = 0; v < camera.height(); ++v) {
    for (int u = 0; u < camera.width(); ++u) {
      const double factor = Factor(u, v);
      if (!(factor >= 0)) {
        throw std::invalid_argument("vignetting: the factor of pixel (" + std::to_string(u) + ", " + std::to_string(v) +
                                    ") is " + std::to_string(factor) +
                                    ", below 0: choose vignetting_2, _4 and _6 nearer to 0");
      }
      factors_.push_back(static_cast<float>(factor));
    }
  }
}

double Vignetting::Factor(double u, double v) const {
  const CameraParams& c = camera_.params();
  const double dx = u - c.cx, dy = v - c.cy;
  const double width = c.width, height = c.height;
  const double r2 = 4 * (dx * dx + dy * dy) / (width * width + height * height);
  double factor = 1 + r2 * (optics_.vignetting_2 + r2 * (optics_.vignetting_4 + r2 * optics_.vignetting_6));
  if (optics_.natural_vignetting) {
    const glm::dvec3 ray = glm::normalize(camera_.Direction({u, v}));
    factor *= ray.z > 0 ? std::pow(ray.z, 4) : 0.0;
  }
  return factor;
}

void Vignetting::Apply(RadianceImage& image) const {
  for (std::size_t i = 0; i < factors_.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) image.rgb[3 * i + c] *= factors_[i];
  }
}

}  // namespace sim
