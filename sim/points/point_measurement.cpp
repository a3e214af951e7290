#include "sim/points/point_measurement.h"

#include <cmath>
#include <numbers>

#include "sim/random/random.h"

namespace sim {
namespace {

Words Draw(const ViewKey& view, Stream stream) { return RandomWords(view.key, stream, view.frame, view.landmark, 0); }

glm::dvec2 Elsewhere(const PointMeasurement& m, const CameraParams& camera, const Words& words,
                     const glm::dvec2& pixel) {
  const double u = Uniform(words[1]), v = Uniform(words[2]);
  if (m.outlier_radius_px == 0) return {u * camera.width - 0.5, v * camera.height - 0.5};
  const double radius = m.outlier_radius_px * std::sqrt(u), angle = 2 * std::numbers::pi * v;
  return pixel + radius * glm::dvec2(std::cos(angle), std::sin(angle));
}

}  // namespace

double BlurLoss(const PointMeasurement& m, double moved_px) {
  if (m.blur_length_px == 0) return 0;
  // 1 / (1 + x^-4), which is finite for any speed.
  const double inverse = m.blur_length_px / moved_px;
  return 1 / (1 + inverse * inverse * inverse * inverse);
}

glm::dvec2 MeasureFirst(const PointMeasurement& m, const ViewKey& view, const glm::dvec2& pixel) {
  const auto z = Normals(Draw(view, Stream::point_noise));
  return pixel + m.noise_px * glm::dvec2(z[0], z[1]);
}

std::optional<glm::dvec2> Measure(const PointMeasurement& m, const CameraParams& camera, const ViewKey& view,
                                  const glm::dvec2& pixel, double moved_px) {
  const Words loss = Draw(view, Stream::point_loss);
  if (Uniform(loss[0]) < m.drop_probability || Uniform(loss[1]) < BlurLoss(m, moved_px)) return std::nullopt;
  const Words outlier = Draw(view, Stream::point_outlier);
  if (Uniform(outlier[0]) < m.outlier_probability) return Elsewhere(m, camera, outlier, pixel);
  return MeasureFirst(m, view, pixel);
}

}  // namespace sim
