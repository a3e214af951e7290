// Moments over particles: of a landmark's predicted image, and of its place in the world.
// Units:   images on the plane z = 1; places in W, m and m^2.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "vo/base/result.h"

namespace vo {

struct ImagePrediction {
  bool in_front = false;  // in front of every particle that matters
  Eigen::Vector2d z = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  // pose and landmark; R not yet in it
};

// Weighted sums over the particles that have the landmark in front.
struct ImageMoments {
  double weight = 0;
  Eigen::Vector2d z = Eigen::Vector2d::Zero();
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();

  void Add(double particle_weight, const ImagePrediction& one) {
    if (!one.in_front) return;
    weight += particle_weight;
    z += particle_weight * one.z;
    second += particle_weight * (one.z * one.z.transpose() + one.covariance);
  }
  ImagePrediction Prediction() const {
    if (weight < 0.5) return {};
    const Eigen::Vector2d mean = z / weight;
    return {true, mean, second / weight - mean * mean.transpose()};
  }
};

// Moments of weighted Gaussians: sum w (P + m m') - mean mean'.
class PointMixture {
 public:
  void Add(double weight, const Eigen::Vector3d& mean, const Eigen::Matrix3d& covariance) {
    if (weight_ == 0) origin_ = mean;
    const Eigen::Vector3d from_origin = mean - origin_;
    weight_ += weight;
    sum_ += weight * from_origin;
    second_ += weight * (covariance + from_origin * from_origin.transpose());
  }
  // None before a weight was added.
  std::optional<PointMoments> Moments() const {
    if (!(weight_ > 0)) return std::nullopt;
    const Eigen::Vector3d mean = sum_ / weight_;
    return PointMoments{origin_ + mean, second_ / weight_ - mean * mean.transpose()};
  }

 private:
  double weight_ = 0;
  // The first mean: sums are taken about it, so that nothing cancels.
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second_ = Eigen::Matrix3d::Zero();
};

}  // namespace vo
