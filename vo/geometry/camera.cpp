#include "vo/geometry/camera.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace vo {
namespace {

// Distance from the principal point, in focal lengths, of a ray at the angle theta from the axis; and its derivative.
struct FisheyeRadius {
  double value, by_theta;
};
FisheyeRadius RadiusAt(const Camera& c, double theta) {
  const double t2 = theta * theta;
  return {theta * (1 + t2 * (c.k1 + t2 * (c.k2 + t2 * (c.k3 + t2 * c.k4)))),
          1 + t2 * (3 * c.k1 + t2 * (5 * c.k2 + t2 * (7 * c.k3 + t2 * 9 * c.k4)))};
}

// A point at distance r on the plane z = 1 is drawn to `scale` times itself; slope = (d scale / dr) / r.
struct FisheyeScale {
  double scale, slope;
};
FisheyeScale ScaleAt(const Camera& c, double r2) {
  if (r2 < 1e-8) return {1 + (c.k1 - 1.0 / 3) * r2, 2 * (c.k1 - 1.0 / 3)};  // atan r = r - r^3 / 3 + ...
  const double r = std::sqrt(r2);
  const FisheyeRadius radius = RadiusAt(c, std::atan(r));
  const double scale = radius.value / r;
  return {scale, (radius.by_theta / (1 + r2) - scale) / r2};
}

// The angle that is drawn at a distance from the principal point: Newton's method, kept between 0 and the widest.
double AngleAt(const Camera& c, double radius) {
  double below = 0, above = kWidestAngle, theta = std::min(radius, kWidestAngle);
  for (int i = 0; i < 60; ++i) {
    const FisheyeRadius now = RadiusAt(c, theta);
    (now.value > radius ? above : below) = theta;
    const double newton = theta - (now.value - radius) / now.by_theta;
    const double next = newton >= below && newton <= above ? newton : 0.5 * (below + above);
    if (std::abs(next - theta) < 1e-15) break;
    theta = next;
  }
  return theta;
}

Eigen::Vector2d Distort(const Camera& c, const Eigen::Vector2d& xy) {
  if (c.lens == Lens::fisheye) return ScaleAt(c, xy.squaredNorm()).scale * xy;
  const double x = xy.x(), y = xy.y(), r2 = x * x + y * y;
  const double d = 1 + r2 * (c.k1 + r2 * (c.k2 + r2 * c.k3));
  return {x * d + 2 * c.p1 * x * y + c.p2 * (r2 + 2 * x * x), y * d + c.p1 * (r2 + 2 * y * y) + 2 * c.p2 * x * y};
}

Eigen::Matrix2d DistortJacobian(const Camera& c, const Eigen::Vector2d& xy) {
  if (c.lens == Lens::fisheye) {
    const FisheyeScale at = ScaleAt(c, xy.squaredNorm());
    return at.scale * Eigen::Matrix2d::Identity() + at.slope * xy * xy.transpose();
  }
  const double x = xy.x(), y = xy.y(), r2 = x * x + y * y;
  const double d = 1 + r2 * (c.k1 + r2 * (c.k2 + r2 * c.k3));
  const double d_r2 = c.k1 + r2 * (2 * c.k2 + r2 * 3 * c.k3);  // dd / d(r2)
  Eigen::Matrix2d J;
  J(0, 0) = d + 2 * x * x * d_r2 + 2 * c.p1 * y + 6 * c.p2 * x;
  J(0, 1) = 2 * x * y * d_r2 + 2 * c.p1 * x + 2 * c.p2 * y;
  J(1, 0) = J(0, 1);
  J(1, 1) = d + 2 * y * y * d_r2 + 6 * c.p1 * y + 2 * c.p2 * x;
  return J;
}

}  // namespace

Eigen::Vector2d Camera::Project(const Eigen::Vector3d& X_C) const {
  const Eigen::Vector2d d = Distort(*this, X_C.head<2>() / X_C.z());
  return {fx * d.x() + cx, fy * d.y() + cy};
}

bool Camera::Draws(const Eigen::Vector2d& xy) const {
  const double r2 = xy.squaredNorm();
  if (lens == Lens::fisheye) return r2 <= std::tan(kWidestAngle) * std::tan(kWidestAngle);
  // The radius r (1 + k1 r^2 + k2 r^4 + k3 r^6) grows as far as its slope, a cubic in s = r^2, has been positive: at the end and at its least.
  const double a = 3 * k1, b = 5 * k2, c = 7 * k3;
  const auto grows = [&](double s) { return 1 + s * (a + s * (b + s * c)) > 0; };
  if (!grows(r2)) return false;
  const double discriminant = b * b - 3 * a * c;
  if (discriminant <= 0) return true;
  const double q = -b - std::copysign(std::sqrt(discriminant), b);  // the cubic's two extrema are q / 3c and a / q
  const auto grows_there = [&](double s) { return !(s > 0 && s < r2) || grows(s); };
  return grows_there(a / q) && (c == 0 || grows_there(q / (3 * c)));
}

bool Camera::HasRay(const Eigen::Vector2d& pixel) const {
  return lens != Lens::fisheye ||
         std::hypot((pixel.x() - cx) / fx, (pixel.y() - cy) / fy) <= RadiusAt(*this, kWidestAngle).value;
}

Eigen::Vector2d Camera::Undistort(const Eigen::Vector2d& pixel) const {
  const Eigen::Vector2d target((pixel.x() - cx) / fx, (pixel.y() - cy) / fy);
  if (lens == Lens::fisheye) {
    const double radius = target.norm();
    return radius < 1e-12 ? target : Eigen::Vector2d(std::tan(AngleAt(*this, radius)) / radius * target);
  }
  Eigen::Vector2d xy = target;
  for (int i = 0; i < 30; ++i) {
    const Eigen::Vector2d step = DistortJacobian(*this, xy).inverse() * (target - Distort(*this, xy));
    xy += step;
    if (step.squaredNorm() < 1e-26) break;
  }
  return xy;
}

Eigen::Matrix2d Camera::LensJacobian(const Eigen::Vector2d& xy) const {
  return Eigen::Vector2d(fx, fy).asDiagonal() * DistortJacobian(*this, xy);
}

bool Camera::Sees(const Eigen::Vector2d& pixel, double border_px) const {
  return pixel.x() >= border_px - 0.5 && pixel.y() >= border_px - 0.5 && pixel.x() <= width - 0.5 - border_px &&
         pixel.y() <= height - 0.5 - border_px && HasRay(pixel);
}

Camera CameraPreset(const std::string& name) {
  Camera camera;
  if (name == "freiburg1") {
    camera = {640,      480,       517.306408, 516.469215, 318.643040, 255.313989,
              0.262383, -0.953104, -0.005358,  0.002628,   1.163314};
  } else if (name == "freiburg2") {
    camera = {640,      480,       520.908620, 521.007327, 325.141442, 249.701764,
              0.231222, -0.784899, -0.003257,  -0.000105,  0.917205};
  } else if (name == "freiburg3") {
    camera = {640, 480, 535.4, 539.2, 320.1, 247.6};
  } else if (name == "icl") {
    camera = {640, 480, 481.2, 480.0, 319.5, 239.5};
  } else {
    throw std::invalid_argument("unknown camera preset '" + name +
                                "': expected freiburg1, freiburg2, freiburg3 or icl");
  }
  if (name != "icl") camera.readout_s = 0.026;
  return camera;
}

Eigen::Matrix2d PixelNoise(const Eigen::Matrix2d& lens, double sigma_px) {
  const Eigen::Matrix2d root = lens.inverse() * sigma_px;
  return root * root.transpose();
}

Eigen::Matrix2d PixelNoise(const Eigen::Matrix2d& lens, const Eigen::Matrix2d& covariance_px) {
  const Eigen::Matrix2d inverse = lens.inverse();
  return inverse * covariance_px * inverse.transpose();
}

}  // namespace vo
