// Residual history of a landmark: the ratio of its matches' squared errors to their stated covariance. Depth edges,
// gloss and repetitive texture are not visible in a single patch; the residuals of several frames show them.
// Source:  conjugate estimate of a variance (inverse gamma), with forgetting. Our addition.
// Units:   variances relative to the covariance R of a match [-].
#pragma once

#include <Eigen/Core>

namespace vo {

// Normalised residual of one match.
struct Residual {
  double ratio = 1;   // squared error over R; 1 on average where R is right
  double weight = 0;  // 0 ... 1: little where the landmark itself is known less well than it is seen

  // r: match less prediction; of the landmark: its own covariance in the image.
  static Residual Of(const Eigen::Vector2d& r, const Eigen::Matrix2d& of_landmark, const Eigen::Matrix2d& R);
};

class ResidualHistory {
 public:
  void Add(const Residual& residual);
  // By what to multiply R from now on: twice the mean of the ratios, since errors of neighbouring frames are alike; no
  // less than 1, for the same reason, and no more than kMost. 2 for a landmark that has not been seen again.
  double Inflation() const;

  static constexpr double kMost = 16;

 private:
  double weight_ = 0, sum_ = 0;
};

}  // namespace vo
