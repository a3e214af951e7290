// Scaled unscented transform: mean, covariance and cross-covariance of y = h(x) for a Gaussian x, from 2 n + 1 points.
// Source:  Julier, "The scaled unscented transformation" (2002); docs/algorithm.md, section 3a. Sums are written about
//          h(mean), so that small alpha, whose central weight is large and negative, does not cancel:
//            mean = y0 + sum_i W_i (y_i - y0)
//            cov  = sum_i W_i (y_i - y0)(y_i - y0)' + (beta - alpha^2) (mean - y0)(mean - y0)'
//          which is positive semi-definite where beta >= alpha^2.
// Shapes:  x is an offset of dimension N from its mean, so that x may live in the tangent space of a pose.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>

namespace vo {

struct UnscentedParams {
  double alpha = 1, beta = 2, kappa = 0;
};

// C with C C' = P. A column is 0 where P has no variance left; P need only be semi-definite.
template <int N>
Eigen::Matrix<double, N, N> SemidefiniteRoot(const Eigen::Matrix<double, N, N>& P) {
  Eigen::Matrix<double, N, N> C = Eigen::Matrix<double, N, N>::Zero();
  for (int j = 0; j < N; ++j) {
    const double pivot = P(j, j) - C.row(j).squaredNorm();
    if (pivot <= 1e-14 * P(j, j)) continue;
    C(j, j) = std::sqrt(pivot);
    for (int i = j + 1; i < N; ++i) C(i, j) = (P(i, j) - C.row(i).dot(C.row(j))) / C(j, j);
  }
  return C;
}

template <int N, int M>
struct UnscentedMoments {
  Eigen::Matrix<double, M, 1> mean;
  Eigen::Matrix<double, M, M> covariance;  // of y
  Eigen::Matrix<double, N, M> cross;       // of x and y
};

template <int N>
class SigmaPoints {
 public:
  static constexpr int kCount = 2 * N + 1;

  SigmaPoints(const Eigen::Matrix<double, N, N>& covariance, const UnscentedParams& params)
      : weight_(0.5 / (params.alpha * params.alpha * (N + params.kappa))),  // 1 / (2 (n + lambda))
        centre_(params.beta - params.alpha * params.alpha) {
    const Eigen::Matrix<double, N, N> spread = std::sqrt(0.5 / weight_) * SemidefiniteRoot<N>(covariance);
    offsets_[0].setZero();
    for (int i = 0; i < N; ++i) {
      offsets_[1 + i] = spread.col(i);
      offsets_[1 + N + i] = -spread.col(i);
    }
  }

  const Eigen::Matrix<double, N, 1>& offset(int i) const { return offsets_[i]; }

  // y[i] = h(mean (+) offset(i)).
  template <int M>
  UnscentedMoments<N, M> Moments(const std::array<Eigen::Matrix<double, M, 1>, kCount>& y) const {
    UnscentedMoments<N, M> moments;
    moments.covariance.setZero();
    moments.cross.setZero();
    Eigen::Matrix<double, M, 1> shift = Eigen::Matrix<double, M, 1>::Zero();
    for (int i = 1; i < kCount; ++i) {
      const Eigen::Matrix<double, M, 1> d = y[i] - y[0];
      shift += weight_ * d;
      moments.covariance += weight_ * d * d.transpose();
      moments.cross += weight_ * offsets_[i] * d.transpose();
    }
    moments.mean = y[0] + shift;
    moments.covariance += centre_ * shift * shift.transpose();
    return moments;
  }

 private:
  double weight_, centre_;
  std::array<Eigen::Matrix<double, N, 1>, kCount> offsets_;
};

// h takes an offset and returns a vector of dimension M.
template <int M, int N, class Function>
UnscentedMoments<N, M> UnscentedTransform(const Eigen::Matrix<double, N, N>& covariance, const UnscentedParams& params,
                                          const Function& h) {
  const SigmaPoints<N> points(covariance, params);
  std::array<Eigen::Matrix<double, M, 1>, SigmaPoints<N>::kCount> y;
  for (int i = 0; i < SigmaPoints<N>::kCount; ++i) y[i] = h(points.offset(i));
  return points.template Moments<M>(y);
}

}  // namespace vo
