// Camera model: projection and back-projection, pinhole with radial-tangential distortion, or fisheye.
// Source: docs/conventions.md, "Camera model" (the models of OpenCV, TUM RGB-D and Kalibr); Kannala and Brandt 2006 for
//   the fisheye, as OpenCV (cv::fisheye) and Kalibr ("equidistant") write it.
// Units: pixels, the centre of the first pixel is (0, 0); directions in C (x right, y down, z forward).
#pragma once

#include <algorithm>
#include <cstddef>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "tools/base/settings/fields.h"

namespace sim {

enum class Lens { radial_tangential, fisheye };

struct CameraParams {
  int width = 640, height = 480;                            // [px]
  double fx = 525.0, fy = 525.0, cx = 319.5, cy = 239.5;    // [px]
  double k1 = 0.0, k2 = 0.0, p1 = 0.0, p2 = 0.0, k3 = 0.0;  // [-]
  double k4 = 0.0;                                          // [-] of a fisheye lens, which has no p1, p2
  Lens lens = Lens::radial_tangential;
};

template <class V>
void Visit(V& v, CameraParams& p) {
  using settings::Range, settings::Unit;
  const Range side{1, 1 << 14};
  v.Required("width", p.width, {side, "of the image [px]"});
  v.Required("height", p.height, {side, "of the image [px]"});
  v.Required("fx", p.fx, {Unit::pixel, Range::Positive(), "focal length"});
  v.Required("fy", p.fy, {Unit::pixel, Range::Positive(), "focal length"});
  v.Required("cx", p.cx, {Unit::pixel, "principal point"});
  v.Required("cy", p.cy, {Unit::pixel, "principal point"});
  v.Child("distortion", [&](auto& lens) {
    lens("model", p.lens, {{"radial_tangential", Lens::radial_tangential}, {"fisheye", Lens::fisheye}}, "of the lens");
    lens("k1", p.k1, {"radial"});
    lens("k2", p.k2, {"radial"});
    if (p.lens == Lens::radial_tangential) lens("p1", p.p1, {"tangential"});
    if (p.lens == Lens::radial_tangential) lens("p2", p.p2, {"tangential"});
    lens("k3", p.k3, {"radial"});
    if (p.lens == Lens::fisheye) lens("k4", p.k4, {"radial, of a fisheye lens"});
  });
}

// Ranges, and rules between several values. The lens must be one-to-one on the whole image: a distortion that folds
// over inside it is a problem.
std::vector<settings::FieldProblem> Problems(CameraParams params);

// Pixel -> direction in C: (X/Z, Y/Z, 1), or a unit vector of a fisheye lens; to 1e-13 (Newton's method). None far
// outside the image, where the lens is not one-to-one.
std::optional<glm::dvec3> Unproject(const CameraParams& params, const glm::dvec2& pixel);

// The camera whose pixels are `factor` x `factor` of this one's.
CameraParams Binned(const CameraParams& params, int factor);

class Camera {
 public:
  // Throws std::invalid_argument listing all Problems.
  explicit Camera(const CameraParams& params);

  const CameraParams& params() const { return params_; }
  int width() const { return params_.width; }
  int height() const { return params_.height; }

  // Point in C -> pixel, lens distortion included. Z > 0; of a fisheye lens any direction but -z.
  glm::dvec2 Project(const glm::dvec3& X_C) const;

  // Unproject. Throws std::invalid_argument where there is none.
  glm::dvec3 Direction(const glm::dvec2& pixel) const;
  // (X/Z, Y/Z) of it. Throws also where Z is not positive.
  glm::dvec2 Undistort(const glm::dvec2& pixel) const;

  // Ray through the centre of a pixel of the image, in C, to 1e-6 px; of a pinhole exact. From a table made once.
  glm::dvec3 PixelRay(int x, int y) const {
    if (!centres_) return {(x - params_.cx) / params_.fx, (y - params_.cy) / params_.fy, 1.0};
    return (
        *centres_)[static_cast<std::size_t>(y) * static_cast<std::size_t>(params_.width) + static_cast<std::size_t>(x)];
  }

  // A pinhole: Ray is linear in the pixel.
  bool straight() const { return table_ == nullptr; }
  // Direction for rendering: from a table made once, linear in a pixel. Within 0.003 px of it for real
  // lenses in pictures of 512 x 512 or more (float rounding is 0.0001 px of it; without distortion nothing else); in
  // smaller ones by a lens's bend within a pixel. Any pixel of the image, borders included.
  glm::vec3 Ray(float u, float v) const {
    if (!table_) return {(u - cx_) * inverse_fx_, (v - cy_) * inverse_fy_, 1.0f};
    const float x = u + 0.5f, y = v + 0.5f;  // the table holds the corners of the pixels
    const int i = std::min(static_cast<int>(x), params_.width - 1),
              j = std::min(static_cast<int>(y), params_.height - 1);
    const float a = x - static_cast<float>(i), b = y - static_cast<float>(j);
    const std::size_t stride = static_cast<std::size_t>(params_.width) + 1;
    const glm::vec3* at = table_->data() + static_cast<std::size_t>(j) * stride + static_cast<std::size_t>(i);
    return (1.0f - b) * ((1.0f - a) * at[0] + a * at[1]) + b * ((1.0f - a) * at[stride] + a * at[stride + 1]);
  }

 private:
  CameraParams params_;
  float cx_, cy_, inverse_fx_, inverse_fy_;
  // Null for a pinhole; copies of a camera share them.
  std::shared_ptr<const std::vector<glm::vec3>> table_;     // rays of the pixels' corners
  std::shared_ptr<const std::vector<glm::dvec3>> centres_;  // and of their centres
};

}  // namespace sim
