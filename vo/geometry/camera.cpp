#include "vo/geometry/camera.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>

namespace vo {
namespace {

constexpr double kReprojectionTolerance = 1e-9;  // on the plane z = 1

// Radial distortion r_d(a) = a (1 + k1 a^2 + k2 a^4 + ...) in focal lengths and dr_d/da, without p1 and p2. a: angle to
// the optical axis for a fisheye lens, distance on the plane z = 1 else.
struct Radius {
  double value, slope;
};
Radius RadiusAt(const Camera& c, double a) {
  const double s = a * a, k4 = c.lens == Lens::fisheye ? c.k4 : 0;
  return {a * (1 + s * (c.k1 + s * (c.k2 + s * (c.k3 + s * k4)))),
          1 + s * (3 * c.k1 + s * (5 * c.k2 + s * (7 * c.k3 + s * 9 * k4)))};
}

// Bernstein coefficients over [0, 1]: the polynomial lies in their convex hull.
using Bernstein = std::array<double, 5>;

// First argument in [0, 1] where the polynomial is not positive, to 2^-halvings.
std::optional<double> FirstZero(const Bernstein& b, int halvings) {
  if (std::all_of(b.begin(), b.end(), [](double x) { return x > 0; })) return std::nullopt;
  if (!(b[0] > 0) || halvings == 0) return 0.0;
  Bernstein left = b, right = b;  // de Casteljau
  for (std::size_t k = 1; k < b.size(); ++k) {
    for (std::size_t i = 0; i + k < b.size(); ++i) right[i] = 0.5 * (right[i] + right[i + 1]);
    left[k] = right[0];
  }
  if (const auto zero = FirstZero(left, halvings - 1)) return 0.5 * *zero;
  if (const auto zero = FirstZero(right, halvings - 1)) return 0.5 + 0.5 * *zero;
  return std::nullopt;
}

// First a <= `farthest` with dr_d/da = 0, a polynomial in s = a^2: the distortion is injective below it.
std::optional<double> TurningPoint(const Camera& c, double farthest) {
  const double s = farthest * farthest, k4 = c.lens == Lens::fisheye ? c.k4 : 0;
  const double c1 = 3 * c.k1 * s, c2 = 5 * c.k2 * s * s, c3 = 7 * c.k3 * s * s * s, c4 = 9 * k4 * s * s * s * s;
  const auto part =
      FirstZero({1, 1 + c1 / 4, 1 + c1 / 2 + c2 / 6, 1 + 3 * c1 / 4 + c2 / 2 + c3 / 4, 1 + c1 + c2 + c3 + c4}, 50);
  return part ? std::optional(farthest * std::sqrt(*part)) : std::nullopt;
}

double LargestInjective(const Camera& c) {
  const double farthest = c.lens == Lens::fisheye ? kMaxFisheyeAngle : std::tan(kMaxFisheyeAngle);
  return TurningPoint(c, farthest).value_or(farthest);
}

// Fisheye: (x, y) is distorted to scale * (x, y), r = |(x, y)|; slope = (d scale / dr) / r.
struct FisheyeScale {
  double scale, slope;
};
FisheyeScale ScaleAt(const Camera& c, double r2) {
  if (r2 < 1e-8) return {1 + (c.k1 - 1.0 / 3) * r2, 2 * (c.k1 - 1.0 / 3)};  // atan r = r - r^3 / 3 + ...
  const double r = std::sqrt(r2);
  const Radius radius = RadiusAt(c, std::atan(r));
  const double scale = radius.value / r;
  return {scale, (radius.slope / (1 + r2) - scale) / r2};
}

// Inverse of r_d(a): Newton's method, bracketed between 0 and the largest injective argument.
double InverseRadius(const Camera& c, double radius) {
  double below = 0, above = LargestInjective(c), away = std::min(radius, above);
  for (int i = 0; i < 60; ++i) {
    const Radius now = RadiusAt(c, away);
    (now.value > radius ? above : below) = away;
    const double newton = away - (now.value - radius) / now.slope;
    const double next = newton >= below && newton <= above ? newton : 0.5 * (below + above);
    if (std::abs(next - away) < 1e-15) break;
    away = next;
  }
  return away;
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

// Newton's method for the ray with Distort(ray) = target, both on the plane z = 1.
Eigen::Vector2d NewtonUndistort(const Camera& c, const Eigen::Vector2d& target, Eigen::Vector2d xy) {
  for (int i = 0; i < 30; ++i) {
    const Eigen::Vector2d step = DistortJacobian(c, xy).inverse() * (target - Distort(c, xy));
    xy += step;
    if (step.squaredNorm() < 1e-26) break;
  }
  return xy;
}

bool IsRayOf(const Camera& c, const Eigen::Vector2d& xy, const Eigen::Vector2d& target) {
  return (Distort(c, xy) - target).norm() <= kReprojectionTolerance && c.IsInjective(xy);
}

// Ray of a radial-tangential lens with Distort(ray) = target, or the widest one in its direction; which of the two.
struct Solution {
  Eigen::Vector2d xy;
  bool is_ray;
};
Solution Solve(const Camera& c, const Eigen::Vector2d& target) {
  const Eigen::Vector2d xy = NewtonUndistort(c, target, target);
  if (IsRayOf(c, xy, target)) return {xy, true};
  // There is no ray, or Newton's method went past the turning point: again from the radial solution.
  const double radius = target.norm();
  const Eigen::Vector2d radial = InverseRadius(c, radius) / radius * target,
                        nearer = NewtonUndistort(c, target, radial);
  if (IsRayOf(c, nearer, target)) return {nearer, true};
  return {radial, IsRayOf(c, radial, target)};
}

Eigen::Vector2d Normalized(const Camera& c, const Eigen::Vector2d& pixel) {
  return {(pixel.x() - c.cx) / c.fx, (pixel.y() - c.cy) / c.fy};
}

}  // namespace

Eigen::Vector2d Camera::Project(const Eigen::Vector3d& X_C) const {
  const Eigen::Vector2d d = Distort(*this, X_C.head<2>() / X_C.z());
  return {fx * d.x() + cx, fy * d.y() + cy};
}

bool Camera::IsInjective(const Eigen::Vector2d& xy) const {
  const double r2 = xy.squaredNorm();
  if (lens == Lens::fisheye)
    return r2 <= std::tan(kMaxFisheyeAngle) * std::tan(kMaxFisheyeAngle) &&
           !TurningPoint(*this, std::atan(std::sqrt(r2)));
  return !TurningPoint(*this, std::sqrt(r2)) && DistortJacobian(*this, xy).determinant() > 0;
}

bool Camera::IsInvertible(const Eigen::Vector2d& pixel) const {
  const Eigen::Vector2d target = Normalized(*this, pixel);
  if (lens == Lens::fisheye)
    return std::hypot(target.x(), target.y()) <= RadiusAt(*this, LargestInjective(*this)).value;
  return Solve(*this, target).is_ray;
}

std::optional<Eigen::Vector2d> Camera::TryUnproject(const Eigen::Vector2d& pixel) const {
  if (lens == Lens::fisheye) return IsInvertible(pixel) ? std::optional(Undistort(pixel)) : std::nullopt;
  const Solution solution = Solve(*this, Normalized(*this, pixel));
  return solution.is_ray ? std::optional(solution.xy) : std::nullopt;
}

Eigen::Vector2d Camera::Undistort(const Eigen::Vector2d& pixel) const {
  const Eigen::Vector2d target = Normalized(*this, pixel);
  if (lens != Lens::fisheye) return Solve(*this, target).xy;
  const double radius = target.norm();
  return radius < 1e-12 ? target : Eigen::Vector2d(std::tan(InverseRadius(*this, radius)) / radius * target);
}

Eigen::Matrix2d Camera::LensJacobian(const Eigen::Vector2d& xy) const {
  return Eigen::Vector2d(fx, fy).asDiagonal() * DistortJacobian(*this, xy);
}

bool Camera::IsUsable(const Eigen::Vector2d& pixel, double border_px) const {
  return pixel.x() >= border_px - 0.5 && pixel.y() >= border_px - 0.5 && pixel.x() <= width - 0.5 - border_px &&
         pixel.y() <= height - 0.5 - border_px && IsInvertible(pixel);
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
