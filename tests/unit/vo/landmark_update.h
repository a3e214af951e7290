// Update of one landmark at a known pose, in matrices: reference for the eight lanes of vo/map/match_lanes.inc.
#pragma once

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "vo/map/landmark.h"
#include "vo/map/match_lanes.h"

namespace vo_test {

using vo::LandmarkUpdate;

// Linearised first at `guess`, then, up to max_iterations in all, at the mode (EKF: guess = prior.mean, max_iterations
// = 1). A landmark behind the camera stays as it is.
inline LandmarkUpdate UpdateLandmark(const vo::Landmark& prior, const Eigen::Vector3d& guess,
                                     const vo::AnchorView& view, const vo::Match& match, int max_iterations) {
  LandmarkUpdate result{prior, 0};
  Eigen::Vector3d theta = guess;
  Eigen::Matrix<double, 3, 2> PJ = Eigen::Matrix<double, 3, 2>::Zero();
  Eigen::Matrix2d S = match.R;
  Eigen::Vector2d e = Eigen::Vector2d::Zero();
  for (int i = 0; i < max_iterations; ++i) {
    const vo::Projection h = vo::Project(view, theta);
    if (!h.in_front) return {prior, 0};
    e = match.z - h.z - h.J_landmark * (prior.mean - theta);
    S = h.J_landmark * prior.covariance * h.J_landmark.transpose() + match.R;
    PJ = prior.covariance * h.J_landmark.transpose();
    result.landmark.mean = prior.mean + PJ * (S.inverse() * e);
    const Eigen::Vector3d step = result.landmark.mean - theta;
    if ((h.J_landmark * step).squaredNorm() < vo::kLandmarkSettled) break;
    theta = result.landmark.mean;
  }
  // At the mode this is Laplace's approximation: r' R^-1 r + (theta - prior)' P^-1 (theta - prior) = e' S^-1 e.
  result.log_likelihood = -0.5 * (e.dot(S.inverse() * e) + std::log(S.determinant())) - std::log(2 * std::numbers::pi);
  result.landmark.covariance -= PJ * S.inverse() * PJ.transpose();
  return result;
}

}  // namespace vo_test
