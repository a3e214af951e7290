// Predicted image of a landmark, and its moments over particles.
// Units:   the plane z = 1.
#pragma once

#include <Eigen/Core>

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

}  // namespace vo
