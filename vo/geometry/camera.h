// Camera model of the odometry: pinhole with radial-tangential distortion, or equidistant fisheye; presets.
// Source:  docs/conventions.md, "Camera model" (the models of OpenCV, TUM RGB-D and Kalibr).
// Units:   pixels; the centre of the first pixel is (0, 0). Rays are (x, y) on the plane z = 1 of C.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

namespace vo {

enum class Lens { radial_tangential, fisheye };

// Largest angle between a usable ray and the optical axis of a fisheye lens: rays are points of the plane z = 1.
constexpr double kMaxFisheyeAngle = 1.4;  // [rad], 80 degrees

struct Camera {
  int width = 640, height = 480;                      // [px]
  double fx = 525, fy = 525, cx = 319.5, cy = 239.5;  // [px]
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0, k3 = 0;      // [-]
  double k4 = 0;                                      // [-] of a fisheye lens, which has no p1, p2
  Lens lens = Lens::radial_tangential;
  // Rolling shutter: from the exposure of the first row to that of the last [s]; 0: global shutter, < 0: last row
  // first. None: not stated.
  std::optional<double> readout_s = 0;

  // Pixel of a point in C with z > 0, lens distortion included.
  Eigen::Vector2d Project(const Eigen::Vector3d& X_C) const;
  // Whether the distortion is injective from the axis to the ray (x, y): d radius / d angle > 0, det LensJacobian > 0,
  // and within kMaxFisheyeAngle for a fisheye lens. Beyond, Project() gives a pixel that belongs to another ray.
  bool IsInjective(const Eigen::Vector2d& xy) const;
  // Whether the pixel, in the image or not, has a ray of that kind: Project(Undistort(pixel)) = pixel to 1e-9 on z = 1.
  bool IsInvertible(const Eigen::Vector2d& pixel) const;
  // Undistort() where the pixel is invertible.
  std::optional<Eigen::Vector2d> TryUnproject(const Eigen::Vector2d& pixel) const;
  // Ray (x, y) of a pixel by Newton's method, to 1e-12; of a pixel that is not invertible the widest ray in its
  // direction (without p1 and p2).
  Eigen::Vector2d Undistort(const Eigen::Vector2d& pixel) const;
  // Whether the pixel is invertible and in the image, at least `border_px` from its edge.
  bool IsUsable(const Eigen::Vector2d& pixel, double border_px = 0) const;
  // d(pixel)/d(x, y) of the lens at the undistorted ray (x, y).
  Eigen::Matrix2d LensJacobian(const Eigen::Vector2d& xy) const;
};

// "freiburg1", "freiburg2", "freiburg3" (TUM RGB-D; the readout of 26 ms is our estimate) or "icl" (ICL-NUIM). Throws
// std::invalid_argument naming the presets.
Camera CameraPreset(const std::string& name);

// Covariance of a pixel's error on the plane z = 1: J^-1 R J^-T with J = `lens` = d pixel / d(x, y),
// Camera::LensJacobian.
Eigen::Matrix2d PixelNoise(const Eigen::Matrix2d& lens, double sigma_px);
Eigen::Matrix2d PixelNoise(const Eigen::Matrix2d& lens, const Eigen::Matrix2d& covariance_px);

}  // namespace vo
