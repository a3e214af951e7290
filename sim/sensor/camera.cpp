#include "sim/sensor/camera.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/matrix.hpp>
#include <initializer_list>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <tuple>

namespace sim {
namespace {

bool IsPinhole(const CameraParams& c) {
  return c.lens == Lens::radial_tangential && c.k1 == 0 && c.k2 == 0 && c.p1 == 0 && c.p2 == 0 && c.k3 == 0;
}

// r(theta) = theta (1 + k1 theta^2 + k2 theta^4 + k3 theta^6 + k4 theta^8), in units of the focal length.
double FisheyeRadius(const CameraParams& c, double theta) {
  const double t2 = theta * theta;
  return theta * (1 + t2 * (c.k1 + t2 * (c.k2 + t2 * (c.k3 + t2 * c.k4))));
}

double FisheyeRadiusByTheta(const CameraParams& c, double theta) {
  const double t2 = theta * theta;
  return 1 + t2 * (3 * c.k1 + t2 * (5 * c.k2 + t2 * (7 * c.k3 + t2 * 9 * c.k4)));
}

// Direction of any length, not along -z -> the point in units of the focal length.
glm::dvec2 FisheyeProject(const CameraParams& c, const glm::dvec3& direction) {
  const double off_axis = std::hypot(direction.x, direction.y);
  if (off_axis == 0) return glm::dvec2(0.0);
  return FisheyeRadius(c, std::atan2(off_axis, direction.z)) / off_axis * glm::dvec2(direction);
}

// The unit direction of a point, to 1e-14; none where the lens is not one-to-one on the way from the axis to it, or
// where it would lie more than pi from the axis.
std::optional<glm::dvec3> FisheyeUnproject(const CameraParams& c, const glm::dvec2& point) {
  const double radius = glm::length(point);
  if (radius == 0) return glm::dvec3(0.0, 0.0, 1.0);
  // March to the first angle that is too large, then halve and refine: a fold on the way is detected.
  constexpr int kSteps = 256;
  double below = 0, above = 0;
  for (int i = 1; i <= kSteps && above == 0; ++i) {
    const double theta = std::numbers::pi * i / kSteps;
    if (!(FisheyeRadiusByTheta(c, theta - 0.5 * std::numbers::pi / kSteps) > 1e-6)) return std::nullopt;
    (FisheyeRadius(c, theta) >= radius ? above : below) = theta;
  }
  if (above == 0 || !(FisheyeRadiusByTheta(c, above) > 1e-6)) return std::nullopt;
  double theta = 0.5 * (below + above);
  for (int i = 0; i < 60; ++i) {
    const double miss = FisheyeRadius(c, theta) - radius;
    (miss > 0 ? above : below) = theta;
    const double newton = theta - miss / FisheyeRadiusByTheta(c, theta);
    const double next = newton > below && newton < above ? newton : 0.5 * (below + above);
    if (std::abs(next - theta) < 1e-15) break;
    theta = next;
  }
  return glm::dvec3(std::sin(theta) / radius * point, std::cos(theta));
}

glm::dvec2 Distort(const CameraParams& c, const glm::dvec2& p) {
  const double x = p.x, y = p.y, r2 = x * x + y * y;
  const double d = 1 + r2 * (c.k1 + r2 * (c.k2 + r2 * c.k3));
  return {x * d + 2 * c.p1 * x * y + c.p2 * (r2 + 2 * x * x), y * d + c.p1 * (r2 + 2 * y * y) + 2 * c.p2 * x * y};
}

// d Distort / d(x, y). It is symmetric.
glm::dmat2 DistortJacobian(const CameraParams& c, const glm::dvec2& p) {
  const double x = p.x, y = p.y, r2 = x * x + y * y;
  const double d = 1 + r2 * (c.k1 + r2 * (c.k2 + r2 * c.k3));
  const double d_by_r2 = c.k1 + r2 * (2 * c.k2 + r2 * 3 * c.k3);
  const double cross = 2 * x * y * d_by_r2 + 2 * c.p1 * x + 2 * c.p2 * y;
  return {d + 2 * x * x * d_by_r2 + 2 * c.p1 * y + 6 * c.p2 * x, cross,  //
          cross, d + 2 * y * y * d_by_r2 + 6 * c.p1 * y + 2 * c.p2 * x};
}

glm::dvec2 Normalized(const CameraParams& c, const glm::dvec2& pixel) {
  return {(pixel.x - c.cx) / c.fx, (pixel.y - c.cy) / c.fy};
}

// Newton's method from p, for a goal not far from Distort(p). False where the lens is not one-to-one on the way.
bool Approach(const CameraParams& c, const glm::dvec2& goal, glm::dvec2& p) {
  for (int i = 0; i < 20; ++i) {
    const glm::dmat2 jacobian = DistortJacobian(c, p);
    if (!(glm::determinant(jacobian) > 1e-6)) return false;
    const glm::dvec2 move = glm::inverse(jacobian) * (goal - Distort(c, p));
    p += move;
    if (glm::length(move) < 1e-14) return glm::determinant(DistortJacobian(c, p)) > 1e-6;
  }
  return false;
}

// The target is approached in steps from the principal point, so that Newton's method does not jump over a fold.
std::optional<glm::dvec3> SolveInSteps(const CameraParams& c, const glm::dvec2& target, int steps) {
  glm::dvec2 p(0.0);
  for (int step = 1; step <= steps; ++step) {
    const glm::dvec2 last = p;
    if (!Approach(c, target * (static_cast<double>(step) / steps), p)) return std::nullopt;
    for (const double part : {0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875}) {
      if (!(glm::determinant(DistortJacobian(c, last + part * (p - last))) > 1e-6)) return std::nullopt;
    }
  }
  return glm::dvec3(p, 1.0);
}

// The direction in the part of the plane around the optical axis on which the lens is one-to-one; none outside of it.
// Where the lens is nearly flat on the way the method converges only from nearby: in more steps.
std::optional<glm::dvec3> Solve(const CameraParams& c, const glm::dvec2& target, std::initializer_list<int> steps) {
  if (c.lens == Lens::fisheye) return FisheyeUnproject(c, target);
  for (const int n : steps) {
    if (const std::optional<glm::dvec3> solution = SolveInSteps(c, target, n)) return solution;
  }
  return std::nullopt;
}

// The ray of a pixel's centre from the table, then one Newton step on Project, which takes the table's 0.003 px to
// 1e-6 px. In small pictures, whose pixels are wide and bent, it may not: then the lens itself is inverted.
glm::dvec3 ExactRay(const Camera& camera, int x, int y) {
  constexpr double kExact_px = 1e-6;
  const auto u = static_cast<float>(x), v = static_cast<float>(y);
  const glm::dvec2 pixel(x, y);
  const glm::dvec3 ray(camera.Ray(u, v));
  const glm::dvec3 du(camera.Ray(u + 0.5f, v) - camera.Ray(u - 0.5f, v)),
      dv(camera.Ray(u, v + 0.5f) - camera.Ray(u, v - 0.5f));
  const glm::dvec2 miss = pixel - camera.Project(ray);
  const glm::dvec3 better = ray + miss.x * du + miss.y * dv;
  return glm::distance(camera.Project(better), pixel) < kExact_px ? better : camera.Direction(pixel);
}

}  // namespace

std::vector<settings::FieldProblem> Problems(CameraParams c) {
  settings::FieldCheck check;
  Visit(check, c);
  const bool are_numbers = check.problems.empty();
  for (const auto& [key, centre, size] : {std::tuple("cx", c.cx, c.width), {"cy", c.cy, c.height}})
    check.Require(!are_numbers || (centre >= -size && centre <= 2.0 * size), key, centre,
                  "is farther from the image than its size");
  if (c.lens == Lens::fisheye) {
    check.Require(c.p1 == 0, "distortion.p1", c.p1, "must be 0: a fisheye lens has no such term");
    check.Require(c.p2 == 0, "distortion.p2", c.p2, "must be 0: a fisheye lens has no such term");
  } else {
    check.Require(c.k4 == 0, "distortion.k4", c.k4, "must be 0: only a fisheye lens has such a term");
  }
  std::vector<settings::FieldProblem>& problems = check.problems;
  if (!problems.empty() || IsPinhole(c)) return problems;
  // The lines from the principal point to the border cover the image.
  const double right = c.width - 0.5, bottom = c.height - 0.5;
  const auto invert = [&](double u, double v) {
    if (!problems.empty() || Solve(c, Normalized(c, {u, v}), {16, 64})) return;
    std::ostringstream text;
    text << "folds over inside the image, before pixel (" << u << ", " << v << ") is reached from its middle";
    problems.push_back({"distortion", text.str()});
  };
  for (int i = 0; i <= c.width; ++i) invert(i - 0.5, -0.5), invert(i - 0.5, bottom);
  for (int j = 0; j <= c.height; ++j) invert(-0.5, j - 0.5), invert(right, j - 0.5);
  return problems;
}

std::optional<glm::dvec3> Unproject(const CameraParams& params, const glm::dvec2& pixel) {
  const glm::dvec2 target = Normalized(params, pixel);
  if (IsPinhole(params)) return glm::dvec3(target, 1.0);
  return Solve(params, target, {4, 16, 64});
}

CameraParams Binned(const CameraParams& params, int factor) {
  CameraParams binned = params;
  binned.width = std::max(1, params.width / factor);
  binned.height = std::max(1, params.height / factor);
  for (double* length : {&binned.fx, &binned.fy}) *length /= factor;
  for (double* centre : {&binned.cx, &binned.cy}) *centre = (*centre + 0.5) / factor - 0.5;
  return binned;
}

Camera::Camera(const CameraParams& params)
    : params_(params),
      cx_(static_cast<float>(params.cx)),
      cy_(static_cast<float>(params.cy)),
      inverse_fx_(static_cast<float>(1 / params.fx)),
      inverse_fy_(static_cast<float>(1 / params.fy)) {
  ThrowIfAny(Problems(params), "camera");
  if (IsPinhole(params)) return;
  auto table = std::make_shared<std::vector<glm::vec3>>();
  table->reserve((static_cast<std::size_t>(params.width) + 1) * (static_cast<std::size_t>(params.height) + 1));
  for (int j = 0; j <= params.height; ++j) {
    glm::dvec3 ray = Direction({-0.5, j - 0.5});
    for (int i = 0; i <= params.width; ++i) {
      glm::dvec2 p(ray);
      const bool is_near =
          params.lens == Lens::radial_tangential && Approach(params, Normalized(params, {i - 0.5, j - 0.5}), p);
      ray = is_near ? glm::dvec3(p, 1.0) : Direction({i - 0.5, j - 0.5});
      table->push_back(ray);
    }
  }
  table_ = std::move(table);
  auto centres = std::make_shared<std::vector<glm::dvec3>>();
  centres->reserve(static_cast<std::size_t>(params.width) * static_cast<std::size_t>(params.height));
  for (int y = 0; y < params.height; ++y)
    for (int x = 0; x < params.width; ++x) centres->push_back(ExactRay(*this, x, y));
  centres_ = std::move(centres);
}

glm::dvec2 Camera::Project(const glm::dvec3& X_C) const {
  const glm::dvec2 d =
      params_.lens == Lens::fisheye ? FisheyeProject(params_, X_C) : Distort(params_, {X_C.x / X_C.z, X_C.y / X_C.z});
  return {params_.fx * d.x + params_.cx, params_.fy * d.y + params_.cy};
}

glm::dvec3 Camera::Direction(const glm::dvec2& pixel) const {
  const std::optional<glm::dvec3> solution = Unproject(params_, pixel);
  if (!solution)
    throw std::invalid_argument("camera: pixel outside the part of the plane where the lens is one-to-one");
  return *solution;
}

glm::dvec2 Camera::Undistort(const glm::dvec2& pixel) const {
  const glm::dvec3 direction = Direction(pixel);
  if (!(direction.z > 0)) throw std::invalid_argument("camera: this pixel looks sideways or back");
  return {direction.x / direction.z, direction.y / direction.z};
}

}  // namespace sim
