// Unscented proposal (15)(16), the paper's own: an unscented update of the predicted pose with all matched features at
// once, and the unscented update of a landmark at a known pose.
// Source:  docs/algorithm.md, section 3a; with pose and velocity sampled this is Unscented FastSLAM 2.0, the paper's
//          baseline. Julier, "The scaled unscented transformation" (2002).
#pragma once

#include <array>
#include <cmath>
#include <span>

#include "vo/filter/proposal.h"
#include "vo/geometry/covariance.h"
#include "vo/map/landmark.h"

namespace vo {

// Scaled unscented transform: mean, covariance and cross-covariance of y = h(x) for a Gaussian x, from 2 n + 1 points.
// x is an offset of dimension N from its mean, so that x may live in the tangent space of a pose. Sums are written
// about h(mean), so that small alpha, whose central weight is large and negative, does not cancel:
//   mean = y0 + sum_i W_i (y_i - y0)
//   cov  = sum_i W_i (y_i - y0)(y_i - y0)' + (beta - alpha^2) (mean - y0)(mean - y0)'
// which is positive semi-definite where beta >= alpha^2.
struct UnscentedParams {
  double alpha = 1, beta = 2, kappa = 0;
};

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

// Sigma points of the pose, q_hat (x) Exp(chi). Given the pose the features are independent of one another, so each is
// linearised statistically by itself, z_n = z_bar_n + C_n (s - s_hat) + noise, and all are used in information form:
// cost linear in the matches. The noise of a feature is the residual of the linear fit, its landmark's part, and R.
// Landmarks that lie behind the camera at a sigma point are left out.
PoseProposal ProposeUnscented(const PoseGaussian& prediction, const LocalMap& map, std::span<const Match> matches,
                              const UnscentedParams& params);

// Its log_likelihood is log N(z; z_hat, S), with the mean and covariance (3) of the sigma points.
LandmarkUpdate UpdateLandmarkUnscented(const Landmark& prior, const AnchorView& view, const Match& match,
                                       const UnscentedParams& params);

}  // namespace vo
