// Purpose: pixel <-> ray of the simulated camera: pinhole with radial-tangential distortion.
// Source:  docs/conventions.md, "Camera model" (the model of OpenCV, TUM RGB-D and Kalibr).
// Units:   pixels, the centre of the first pixel is (0, 0); directions in C (x right, y down, z forward).
#pragma once

#include <algorithm>
#include <cstddef>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <string>
#include <vector>

namespace sim {

struct CameraParams {
  int width = 640, height = 480;                            // [px]
  double fx = 525.0, fy = 525.0, cx = 319.5, cy = 239.5;    // [px]
  double k1 = 0.0, k2 = 0.0, p1 = 0.0, p2 = 0.0, k3 = 0.0;  // [-]
};

// Everything wrong with the parameters, one sentence each; empty when all is well. The lens must be one-to-one on the
// whole image: a distortion that folds over inside it is a problem.
std::vector<std::string> Problems(const CameraParams& params);

class Camera {
 public:
  // Throws std::invalid_argument listing all Problems.
  explicit Camera(const CameraParams& params);

  const CameraParams& params() const { return params_; }
  int width() const { return params_.width; }
  int height() const { return params_.height; }

  // Point in C with Z > 0 -> pixel, lens distortion included.
  glm::dvec2 Project(const glm::dvec3& X_C) const;

  // Pixel -> (X/Z, Y/Z) of its ray, to 1e-13 (Newton's method). Throws std::invalid_argument far outside the image,
  // where the lens is not one-to-one.
  glm::dvec2 Undistort(const glm::dvec2& pixel) const;

  // The same for rendering: from a table made once, within 0.003 px of Undistort for lenses that are one-to-one in the
  // image (float rounding is 0.0001 px of it; without distortion nothing else). Any pixel of the image, borders
  // included.
  glm::vec2 Ray(float u, float v) const {
    if (!table_) return {(u - cx_) * inverse_fx_, (v - cy_) * inverse_fy_};
    const float x = u + 0.5f, y = v + 0.5f;  // the table holds the corners of the pixels
    const int i = std::min(static_cast<int>(x), params_.width - 1),
              j = std::min(static_cast<int>(y), params_.height - 1);
    const float a = x - static_cast<float>(i), b = y - static_cast<float>(j);
    const std::size_t stride = static_cast<std::size_t>(params_.width) + 1;
    const glm::vec2* at = table_->data() + static_cast<std::size_t>(j) * stride + static_cast<std::size_t>(i);
    return (1.0f - b) * ((1.0f - a) * at[0] + a * at[1]) + b * ((1.0f - a) * at[stride] + a * at[stride + 1]);
  }

 private:
  CameraParams params_;
  float cx_, cy_, inverse_fx_, inverse_fy_;
  std::shared_ptr<const std::vector<glm::vec2>> table_;  // null without distortion; copies of a camera share it
};

}  // namespace sim
