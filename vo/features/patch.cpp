#include "vo/features/patch.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "vo/base/vectors.h"
#include "vo/features/motion_blur.h"

namespace vo {
namespace {

constexpr int kWindowRadius = 4;  // registered part of the patch
constexpr int kWindow = 2 * kWindowRadius + 1;
constexpr int kPixels = kWindow * kWindow;
constexpr int kIterations = 10;
constexpr double kConvergedPx = 0.01;
constexpr float kReachOfWarp = 10;  // [px] of the window in the patch: a stronger warp is not registered

using Window = Eigen::Matrix<float, kPixels, 1>;
using WideWindow = Eigen::Matrix<float, kWindow + 2, kWindow + 2>;

inline float Bilinear(const std::uint8_t* data, std::size_t stride, float x, float y) {
  const int ix = static_cast<int>(x), iy = static_cast<int>(y);
  const float fx = x - static_cast<float>(ix), fy = y - static_cast<float>(iy);
  const std::uint8_t* p = data + static_cast<std::size_t>(iy) * stride + ix;
  return (1 - fy) * ((1 - fx) * p[0] + fx * p[1]) + fy * ((1 - fx) * p[stride] + fx * p[stride + 1]);
}

// Row of a window, in vectors.
struct Row {
  static constexpr int kLanes = 4;
  static_assert(kWindow == 2 * kLanes + 1);
  using Floats = Vector<float, kLanes>;
  Floats left, middle;
  float last;

  // fx: interpolated between each pixel and the next.
  Row(const std::uint8_t* p, float fx)
      : left(Between(Grey(p), Grey(p + 1), fx)),
        middle(Between(Grey(p + kLanes), Grey(p + kLanes + 1), fx)),
        last(Between<float>(p[2 * kLanes], p[2 * kLanes + 1], fx)) {}

  void Interpolate(const Row& below, float fy, float* out) const {
    const Floats a = Between(left, below.left, fy), b = Between(middle, below.middle, fy);
    Store(a, out);
    Store(b, out + kLanes);
    out[2 * kLanes] = Between(last, below.last, fy);
  }

 private:
  template <class T>
  static T Between(T a, T b, float share) {
    return a + share * (b - a);
  }
  static Floats Grey(const std::uint8_t* p) {
    return __builtin_convertvector(Load<Vector<std::uint8_t, kLanes>>(p), Floats);
  }
};

// Window about a sub-pixel position, bilinear: the same weights for all pixels.
Window SampleWindow(const std::uint8_t* data, std::size_t stride, const Eigen::Vector2d& centre) {
  const int ix = static_cast<int>(centre.x()), iy = static_cast<int>(centre.y());
  const auto fx = static_cast<float>(centre.x() - ix), fy = static_cast<float>(centre.y() - iy);
  const std::uint8_t* p = data + static_cast<std::size_t>(iy - kWindowRadius) * stride + ix - kWindowRadius;
  Window window;
  Row above(p, fx);
  for (int v = 0; v < kWindow; ++v) {
    p += stride;
    const Row below(p, fx);
    above.Interpolate(below, fy, window.data() + v * kWindow);
    above = below;
  }
  return window;
}

// Patch warped to the present view, one pixel wider than the window for the gradient. False: it leaves the patch.
bool WarpPatch(const Patch& patch, const Eigen::Matrix2d& warp, WideWindow& out) {
  constexpr int kReach = kWindowRadius + 1;
  const Eigen::Matrix2f to_first = warp.inverse().cast<float>();
  const Eigen::Vector2f farthest = kReach * to_first.cwiseAbs().rowwise().sum();  // over the four corners
  if (!(farthest.maxCoeff() < kReachOfWarp)) return false;
  for (int v = -kReach; v <= kReach; ++v) {
    const Eigen::Vector2f row = static_cast<float>(v) * to_first.col(1) + Eigen::Vector2f::Constant(Patch::kRadius);
    for (int u = -kReach; u <= kReach; ++u) {
      const Eigen::Vector2f at = row + static_cast<float>(u) * to_first.col(0);
      out(v + kReach, u + kReach) = Bilinear(patch.grey.data(), Patch::kSide, at.x(), at.y());
    }
  }
  return true;
}

// Information of a patch's gradients on a shift, along the eigenvectors of the structure tensor H = sum g g', above the
// level of noise and of the pixel grid. The first eigenvector lies along an edge.
class StructureTensor {
 public:
  // `ripple`: mean square of the patch's mixed second differences, high for noise and low for anything smooth.
  StructureTensor(const Eigen::Matrix2d& H, double ripple) : ripple_(ripple) { solver_.computeDirect(H); }

  // Removes the first eigenvector, along which the iteration has diverged (aperture problem).
  void RestrictToNormal() { normal_only_ = true; }

  // Reduction of the sum of squares by the least-squares step, b' H^-1 b with b = `slope`.
  double Explained(const Eigen::Vector2d& slope) const {
    const Eigen::Array2d along = solver_.eigenvectors().transpose() * slope;
    return (along.square() / solver_.eigenvalues().array().max(kStaircase * solver_.eigenvalues()[1])).sum();
  }

  // H^-1, zero along an eigenvector without information.
  Eigen::Matrix2d Inverse(double residual_variance) const {
    Eigen::Vector2d inverse;
    for (int i = 0; i < 2; ++i) inverse[i] = Information(i, residual_variance) > 0 ? 1 / solver_.eigenvalues()[i] : 0;
    return Rotated(inverse);
  }

  // Bounded by half the window's width.
  Eigen::Matrix2d Covariance(double residual_variance) const {
    constexpr double kWidest = kWindowRadius * kWindowRadius;
    Eigen::Vector2d variances;
    for (int i = 0; i < 2; ++i) {
      const double information = Information(i, residual_variance);
      variances[i] = kWidest * information > kCorrelated * residual_variance
                         ? kCorrelated * residual_variance / information
                         : kWidest;
    }
    return Rotated(variances);
  }

 private:
  // Smaller eigenvalue of a straight edge over the larger one: aliasing on the pixel grid.
  static constexpr double kStaircase = 0.02;
  // Gradient variance per pixel of smoothed white noise in both images: 0.27 of the residual variance, 0.17 of the
  // ripple. Twice that covers the spread over patches; the smaller of both is used, since model error adds to each.
  static constexpr double kOfResidual = 0.5, kOfRipple = 0.34;
  // Noise of neighbouring pixels is correlated after smoothing: variance at low spatial frequency over that per pixel.
  static constexpr double kCorrelated = 2.5;

  double Information(int axis, double residual_variance) const {
    if (normal_only_ && axis == 0) return 0;
    const double noise = kPixels * std::min(kOfResidual * residual_variance, kOfRipple * ripple_);
    return solver_.eigenvalues()[axis] - kStaircase * solver_.eigenvalues()[1] - noise;
  }
  Eigen::Matrix2d Rotated(const Eigen::Vector2d& along) const {
    return solver_.eigenvectors() * along.asDiagonal() * solver_.eigenvectors().transpose();
  }

  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver_;
  double ripple_;
  bool normal_only_ = false;
};

double Ripple(const WideWindow& wide) {
  float sum = 0;
  for (int v = 1; v <= kWindow; ++v)
    for (int u = 1; u <= kWindow; ++u) {
      const auto bend = [&](int row) { return wide(row, u - 1) - 2 * wide(row, u) + wide(row, u + 1); };
      const float cross = bend(v - 1) - 2 * bend(v) + bend(v + 1);
      sum += cross * cross;
    }
  return sum / kPixels;
}

}  // namespace

cv::Mat Smooth(const cv::Mat& grey) {
  cv::Mat smooth;
  cv::GaussianBlur(grey, smooth, {3, 3}, 0.7, 0.7, cv::BORDER_REPLICATE);
  return smooth;
}

Patch CutPatch(const cv::Mat& smooth, const Eigen::Vector2i& centre) {
  Patch patch;
  for (int row = 0; row < Patch::kSide; ++row)
    std::copy_n(smooth.ptr(centre.y() - Patch::kRadius + row) + centre.x() - Patch::kRadius, Patch::kSide,
                patch.grey.begin() + std::ptrdiff_t{row} * Patch::kSide);
  return patch;
}

std::optional<Registration> Register(const Patch& patch, const Eigen::Matrix2d& warp, const cv::Mat& smooth,
                                     const Eigen::Vector2d& start, double max_shift_px, const Eigen::Vector2d& streak) {
  WideWindow wide;
  if (!(std::abs(warp.determinant()) > kLeastWarp) || !WarpPatch(patch, warp, wide)) return std::nullopt;
  const BlurSamples samples(streak);
  const Eigen::Vector2d reach = streak.cwiseAbs() / 2 + Eigen::Vector2d::Constant(kWindowRadius);

  Window templ, gradient_x, gradient_y;
  for (int v = 0, i = 0; v < kWindow; ++v)
    for (int u = 0; u < kWindow; ++u, ++i) {
      templ[i] = wide(v + 1, u + 1);
      gradient_x[i] = 0.5F * (wide(v + 1, u + 2) - wide(v + 1, u));
      gradient_y[i] = 0.5F * (wide(v + 2, u + 1) - wide(v, u + 1));
    }
  for (Window* w : {&templ, &gradient_x, &gradient_y}) w->array() -= w->mean();
  const float template_norm = templ.norm();
  Eigen::Matrix2d H;
  H(0, 0) = gradient_x.squaredNorm();
  H(0, 1) = H(1, 0) = gradient_x.dot(gradient_y);
  H(1, 1) = gradient_y.squaredNorm();
  if (!(template_norm > 1)) return std::nullopt;
  StructureTensor tensor(H, Ripple(wide));

  const auto iterate = [&]() -> std::optional<Registration> {
    Eigen::Vector2d x = start;
    for (int iteration = 0; iteration < kIterations; ++iteration) {
      if (!(x.x() >= reach.x() && x.y() >= reach.y() && x.x() < smooth.cols - reach.x() - 1 &&
            x.y() < smooth.rows - reach.y() - 1))
        return std::nullopt;
      Window seen = SampleWindow(smooth.data, smooth.step[0], x + samples.offset(0));
      for (int k = 1; k < samples.count(); ++k)
        seen += SampleWindow(smooth.data, smooth.step[0], x + samples.offset(k));
      seen /= static_cast<float>(samples.count());
      seen.array() -= seen.mean();
      const float seen_norm = seen.norm();
      if (!(seen_norm > 1)) return std::nullopt;
      seen *= template_norm / seen_norm;  // gain
      const Window off = templ - seen;
      const Eigen::Vector2d slope(gradient_x.dot(off), gradient_y.dot(off));
      // Residual variance; gain, offset and two shifts are fitted.
      const double variance =
          std::max(0.0, static_cast<double>(off.squaredNorm()) - tensor.Explained(slope)) / (kPixels - 4);
      const Eigen::Matrix2d inverse = tensor.Inverse(variance);
      if (inverse.isZero(0)) return std::nullopt;
      const Eigen::Vector2d step = inverse * slope;
      x += step;
      if ((x - start).norm() > max_shift_px) return std::nullopt;
      if (step.norm() < kConvergedPx)
        return Registration{x, templ.dot(seen) / (template_norm * template_norm), tensor.Covariance(variance)};
    }
    return std::nullopt;
  };
  if (auto found = iterate()) return found;
  tensor.RestrictToNormal();
  return iterate();
}

}  // namespace vo
