// Purpose: the camera as the odometry knows it: pinhole with radial-tangential distortion, or fisheye; presets.
// Source:  docs/conventions.md, "Camera model" (the models of OpenCV, TUM RGB-D and Kalibr).
// Units:   pixels; the centre of the first pixel is (0, 0). Rays are in C, on the plane z = 1.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

namespace vo {

enum class Lens { radial_tangential, fisheye };

// Of a fisheye lens only what lies within kWidestAngle of the optical axis, and within the angle where its radius ceases to grow, is used: rays
// are points of the plane z = 1.
constexpr double kWidestAngle = 1.4;  // [rad], 80 degrees

struct Camera {
  int width = 640, height = 480;                      // [px]
  double fx = 525, fy = 525, cx = 319.5, cy = 239.5;  // [px]
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0, k3 = 0;      // [-]
  double k4 = 0;                                      // [-] of a fisheye lens, which has no p1, p2
  Lens lens = Lens::radial_tangential;
  // Rolling shutter: from the first row's exposure to the last's [s]; 0: all at once, < 0: upwards.
  double readout_s = 0;

  // Point in C with z > 0 -> pixel, lens distortion included.
  Eigen::Vector2d Project(const Eigen::Vector3d& X_C) const;
  // Whether the pixel of a ray (x, y) on the plane z = 1 is that ray's own. Past the angle where the lens's radius ceases to grow, where p1 and
  // p2 fold the picture, or past kWidestAngle of a fisheye, Project() answers with a pixel of another ray.
  bool Draws(const Eigen::Vector2d& xy) const;
  // Whether a ray that can be used is drawn at a pixel, wherever it lies: it is Undistort's, to 1e-9 on the plane z = 1.
  bool HasRay(const Eigen::Vector2d& pixel) const;
  // That ray; Undistort's where there is one.
  std::optional<Eigen::Vector2d> RayOf(const Eigen::Vector2d& pixel) const;
  // Pixel -> undistorted ray (x, y) on the plane z = 1, to 1e-12 by Newton's method; of a pixel without one, the widest in its direction (p1 and
  // p2 apart).
  Eigen::Vector2d Undistort(const Eigen::Vector2d& pixel) const;
  // Where a camera of the same fx, fy, cx, cy without distortion would see that ray [px].
  Eigen::Vector2d Ideal(const Eigen::Vector2d& pixel) const;
  // Whether a pixel lies in the image, `border_px` from its edge, and has a ray.
  bool Sees(const Eigen::Vector2d& pixel, double border_px = 0) const;
  // d(pixel)/d(x, y) of the lens at the undistorted ray (x, y).
  Eigen::Matrix2d LensJacobian(const Eigen::Vector2d& xy) const;
};

// "freiburg1|freiburg2|freiburg3" (TUM RGB-D; that its Kinects read their rows in 26 ms is our estimate), "icl" (ICL-NUIM). Throws std::invalid_argument naming the presets.
Camera CameraPreset(const std::string& name);

// The covariance of a pixel, seen on the plane z = 1. `lens` = d pixel / d(plane z = 1), Camera::LensJacobian.
Eigen::Matrix2d PixelNoise(const Eigen::Matrix2d& lens, double sigma_px);
Eigen::Matrix2d PixelNoise(const Eigen::Matrix2d& lens, const Eigen::Matrix2d& covariance_px);

}  // namespace vo
