// Where the landmarks are in the world, as each filter has them.
#include "vo/filter/ekf_slam.h"
#include "vo/filter/particle_filter.h"

namespace vo {

// Over particles: each has the landmark as a Gaussian on its own path, anchors taken as known there.
std::vector<std::optional<PointMoments>> ParticleFilter::LandmarkPoints() const {
  std::vector<std::optional<PointMoments>> points;
  for (int n = 0; n < landmark_count(); ++n) {
    PointMixture mixture;
    bool in_front = true;
    for (std::size_t i = 0; i < particles_.size() && in_front; ++i) {
      if (weights_[i] == 0) continue;
      const Particle& particle = particles_[i];
      const Pose& anchor = particle.anchors[anchor_of_[n]];
      const Eigen::Vector3d& theta = ModeOf(particle, n);
      in_front = theta.z() > 0;
      if (!in_front) break;
      const Eigen::Matrix3d J = PointJacobian(anchor, theta);
      mixture.Add(weights_[i], PointInWorld(anchor, theta), J * particle.landmarks[n].covariance * J.transpose());
    }
    points.push_back(in_front ? mixture.Moments() : std::nullopt);
  }
  return points;
}

// Of the joint Gaussian, the anchor's pose and its correlation with the landmark included.
std::vector<std::optional<PointMoments>> EkfSlam::LandmarkPoints() const {
  std::vector<std::optional<PointMoments>> points;
  for (int n = 0; n < landmark_count(); ++n) {
    const Pose& anchor = anchors_[anchor_of_[n]];
    const Eigen::Vector3d& theta = landmarks_[n].mean;
    if (!(theta.z() > 0)) {
      points.push_back(std::nullopt);
      continue;
    }
    const int a = anchor_offset_[anchor_of_[n]], l = landmark_offset_[n];
    Eigen::Matrix<double, 3, 9> J;
    J << PointAnchorJacobian(anchor, theta), PointJacobian(anchor, theta);
    Eigen::Matrix<double, 9, 9> P;
    P << P_.block<6, 6>(a, a), P_.block<6, 3>(a, l), P_.block<3, 6>(l, a), P_.block<3, 3>(l, l);
    points.push_back(PointMoments{PointInWorld(anchor, theta), J * P * J.transpose()});
  }
  return points;
}

}  // namespace vo
