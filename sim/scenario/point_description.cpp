#include "sim/scenario/point_description.h"

#include <algorithm>
#include <cmath>

#include "sim/sensor/fisheye.h"
#include "tools/base/settings/require.h"

namespace sim {
namespace {

// Whether what is seen at all places within the margin has Z > 0. The corners look farthest from the axis.
bool LooksAhead(const CameraParams& c, double margin_px) {
  if (c.lens != Lens::fisheye) return true;
  for (const double u : {margin_px - 0.5, c.width - margin_px - 0.5}) {
    for (const double v : {margin_px - 0.5, c.height - margin_px - 0.5}) {
      const auto direction = Fisheye{{c.k1, c.k2, c.k3, c.k4}}.Unproject({(u - c.cx) / c.fx, (v - c.cy) / c.fy});
      if (direction && !(direction->z > 0)) return false;
    }
  }
  return true;
}

}  // namespace

std::vector<std::string> Problems(const PointDescription& p, const CameraParams& camera) {
  settings::Require require;
  constexpr int kMost = 1'000'000;
  require(p.count >= 1 && p.count <= kMost, "count", p.count, "must lie in 1 ... 1000000");
  require(p.forget_after >= 1, "forget_after", p.forget_after, "must be at least 1");
  require(true, "inverse_depth", p.inverse_depth, "1/m must be finite");
  require(p.inverse_depth_sigma >= 0, "inverse_depth_sigma", p.inverse_depth_sigma, "1/m must be at least 0");
  require(p.scale_sigma >= 0 && p.scale_sigma <= 3, "scale_sigma", p.scale_sigma, "must lie in 0 ... 3");
  require(p.margin_px >= 0 && 2 * p.margin_px < std::min(camera.width, camera.height), "margin", p.margin_px,
          "px must be at least 0 and leave something of the image");
  require(
      p.landmarks != Landmarks::prior || LooksAhead(camera, p.margin_px), "margin", p.margin_px,
      "px must leave out what the fisheye lens sees 90 degrees and more from its axis: a landmark of a prior begins "
      "in front of the camera");
  require(p.points >= 1 && p.points <= kMost, "points", p.points, "must lie in 1 ... 1000000");
  require(p.size_m > 0, "size", p.size_m, "m must be positive");
  require(p.distance_m > 0, "distance", p.distance_m, "m must be positive");
  require(p.min_depth_m >= 0, "min_depth", p.min_depth_m, "m must be at least 0");
  const PointMeasurement& m = p.measurement;
  require(m.noise_px >= 0, "measurement.noise", m.noise_px, "px must be at least 0");
  require(m.outlier_probability >= 0 && m.outlier_probability <= 1, "measurement.outliers.probability",
          m.outlier_probability, "must lie in 0 ... 1");
  require(m.outlier_radius_px >= 0, "measurement.outliers.radius", m.outlier_radius_px, "px must be at least 0");
  require(m.drop_probability >= 0 && m.drop_probability <= 1, "measurement.drops", m.drop_probability,
          "must lie in 0 ... 1");
  require(m.blur_length_px >= 0, "measurement.blur.length", m.blur_length_px, "px must be at least 0");
  require(m.blur_exposure_s >= 0, "measurement.blur.exposure", m.blur_exposure_s, "s must be at least 0");
  return require.problems;
}

}  // namespace sim
