#include "vo/features/patch.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace vo {
namespace {

constexpr int kWindowRadius = 4;  // of the registered window
constexpr int kWindow = 2 * kWindowRadius + 1;
constexpr int kPixels = kWindow * kWindow;
constexpr int kIterations = 10;
constexpr double kSettledPx = 0.01;

using Window = Eigen::Matrix<double, kPixels, 1>;

inline double Bilinear(const std::uint8_t* data, std::size_t stride, double x, double y) {
  const int ix = static_cast<int>(x), iy = static_cast<int>(y);
  const double fx = x - ix, fy = y - iy;
  const std::uint8_t* p = data + static_cast<std::size_t>(iy) * stride + ix;
  return (1 - fy) * ((1 - fx) * p[0] + fx * p[1]) + fy * ((1 - fx) * p[stride] + fx * p[stride + 1]);
}

// The window about a place between the pixels: all of them are cut in the same ratio.
Window Between(const std::uint8_t* data, std::size_t stride, const Eigen::Vector2d& centre) {
  const int ix = static_cast<int>(centre.x()), iy = static_cast<int>(centre.y());
  const double fx = centre.x() - ix, fy = centre.y() - iy;
  const std::uint8_t* p = data + static_cast<std::size_t>(iy - kWindowRadius) * stride + ix - kWindowRadius;
  double above[kWindow];
  Window window;
  for (int v = 0; v <= kWindow; ++v, p += stride)
    for (int u = 0; u < kWindow; ++u) {
      const double here = (1 - fx) * p[u] + fx * p[u + 1];
      if (v > 0) window[(v - 1) * kWindow + u] = (1 - fy) * above[u] + fy * here;
      above[u] = here;
    }
  return window;
}

// The patch as the present view should show it; one pixel wider than the window for its gradient. False: leaves the patch.
bool WarpPatch(const Patch& patch, const Eigen::Matrix2d& warp, Eigen::Matrix<double, kWindow + 2, kWindow + 2>& out) {
  constexpr int kReach = kWindowRadius + 1;
  const Eigen::Matrix2d to_first = warp.inverse();
  const Eigen::Vector2d farthest = kReach * to_first.cwiseAbs().rowwise().sum();  // at two of the four corners
  if (!(Patch::kRadius - farthest.maxCoeff() >= 0 && Patch::kRadius + farthest.maxCoeff() < Patch::kSide - 1)) return false;
  for (int v = -kReach; v <= kReach; ++v) {
    const Eigen::Vector2d row = v * to_first.col(1) + Eigen::Vector2d::Constant(Patch::kRadius);
    for (int u = -kReach; u <= kReach; ++u)
      out(v + kReach, u + kReach) =
          Bilinear(patch.grey.data(), Patch::kSide, row.x() + u * to_first(0, 0), row.y() + u * to_first(1, 0));
  }
  return true;
}

}  // namespace

Patch CutPatch(const cv::Mat& grey, const Eigen::Vector2i& centre) {
  Patch patch;
  for (int row = 0; row < Patch::kSide; ++row)
    std::copy_n(grey.ptr(centre.y() - Patch::kRadius + row) + centre.x() - Patch::kRadius, Patch::kSide,
                patch.grey.begin() + row * Patch::kSide);
  return patch;
}

double Cornerness(const Patch& patch) {
  Eigen::Matrix2d moments = Eigen::Matrix2d::Zero();
  const auto grey = [&](int x, int y) {
    return static_cast<double>(patch.grey[static_cast<std::size_t>((y + Patch::kRadius) * Patch::kSide + x + Patch::kRadius)]);
  };
  for (int y = -kWindowRadius; y <= kWindowRadius; ++y)
    for (int x = -kWindowRadius; x <= kWindowRadius; ++x) {
      const Eigen::Vector2d g(grey(x + 1, y) - grey(x - 1, y), grey(x, y + 1) - grey(x, y - 1));
      moments += g * g.transpose();
    }
  const double half_trace = 0.5 * moments.trace();
  const double root = std::sqrt(std::max(0.0, half_trace * half_trace - moments.determinant()));
  return half_trace > 0 ? (half_trace - root) / (half_trace + root) : 0.0;
}

std::optional<Registration> Register(const Patch& patch, const Eigen::Matrix2d& warp, const cv::Mat& grey,
                                     const Eigen::Vector2d& start, double max_shift_px) {
  Eigen::Matrix<double, kWindow + 2, kWindow + 2> wide;
  if (!(std::abs(warp.determinant()) > 0.1) || !WarpPatch(patch, warp, wide)) return std::nullopt;

  Window templ, gradient_x, gradient_y;
  for (int v = 0, i = 0; v < kWindow; ++v)
    for (int u = 0; u < kWindow; ++u, ++i) {
      templ[i] = wide(v + 1, u + 1);
      gradient_x[i] = 0.5 * (wide(v + 1, u + 2) - wide(v + 1, u));
      gradient_y[i] = 0.5 * (wide(v + 2, u + 1) - wide(v, u + 1));
    }
  for (Window* w : {&templ, &gradient_x, &gradient_y}) w->array() -= w->mean();
  const double template_norm = templ.norm();
  Eigen::Matrix2d H;
  H(0, 0) = gradient_x.squaredNorm();
  H(0, 1) = H(1, 0) = gradient_x.dot(gradient_y);
  H(1, 1) = gradient_y.squaredNorm();
  if (!(template_norm > 1) || !(H.determinant() > 1e-3 * H.trace() * H.trace())) return std::nullopt;
  const Eigen::Matrix2d H_inverse = H.inverse();

  Eigen::Vector2d x = start;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    if (!(x.x() >= kWindowRadius && x.y() >= kWindowRadius && x.x() < grey.cols - kWindowRadius - 1 &&
          x.y() < grey.rows - kWindowRadius - 1))
      return std::nullopt;
    Window seen = Between(grey.data, grey.step[0], x);
    seen.array() -= seen.mean();
    const double seen_norm = seen.norm();
    if (!(seen_norm > 1)) return std::nullopt;
    seen *= template_norm / seen_norm;  // gain
    const Window off = templ - seen;
    const Eigen::Vector2d step = H_inverse * Eigen::Vector2d(gradient_x.dot(off), gradient_y.dot(off));
    x += step;
    if ((x - start).norm() > max_shift_px) return std::nullopt;
    if (step.norm() < kSettledPx) {
      const double variance = off.squaredNorm() / (kPixels - 4);  // gain, offset and two shifts are fitted
      return Registration{x, templ.dot(seen) / (template_norm * template_norm), variance * H_inverse};
    }
  }
  return std::nullopt;
}

}  // namespace vo
