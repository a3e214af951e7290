// Where the landmarks are in the world, as each filter has them.
#include <cmath>

#include "vo/filter/ekf_slam.h"
#include "vo/filter/particle_filter.h"
#include "vo/geometry/symmetric.h"

namespace vo {

// Also of those that the window has not seen; of the poses as they are now, some sampled since they were solved.
std::vector<Track> ParticleFilter::TrackOfEach() const {
  std::vector<Track> tracks;
  for (int n = 0; n < landmark_count(); ++n) tracks.push_back({n, anchor_of_[n], anchor_slot_[anchor_of_[n]], {}});
  for (int slot = 0; slot < static_cast<int>(steps_.size()); ++slot)
    for (const Match& match : steps_[slot].matches) tracks[match.landmark].views.push_back(ViewOf(match, slot));
  return tracks;
}

// In the start's window the first particle's are all's: a depth hangs on no start pose.
std::vector<double> ParticleFilter::InverseDepthSigmas() const {
  if (!delayed()) return Filter::InverseDepthSigmas();
  const std::size_t leaders = together() ? 1 : particles_.size();
  std::vector<double> sigmas;
  for (const Track& track : TrackOfEach()) {
    double mean = 0, square = 0;  // seen from the first particle's
    const double origin = ModeOf(particles_[0], track.landmark).z();
    for (std::size_t i = 0; i < leaders; ++i) {
      const Particle& particle = particles_[i];
      const double weight = together() ? 1 : weights_[i];
      if (weight == 0) continue;
      const Eigen::Vector3d& theta = ModeOf(particle, track.landmark);
      const double off = theta.z() - origin;
      mean += weight * off;
      square += weight * (PathWindow::WithAnchor(InputOf(particle), track, particle.path, theta)(8, 8) + off * off);
    }
    sigmas.push_back(std::sqrt(square - mean * mean));
  }
  return sigmas;
}

// In W, on the particle's path as far as it is sampled; what is not is as uncertain as it is, the first view's pose included.
Eigen::Matrix3d ParticleFilter::PointCovariance(const Particle& particle, const Track& track) const {
  const Pose& anchor = particle.anchors[track.anchor];
  const Eigen::Vector3d& theta = ModeOf(particle, track.landmark);
  const Eigen::Matrix3d J = PointJacobian(anchor, theta);
  if (!delayed()) return J * particle.landmarks[track.landmark].covariance * J.transpose();
  Eigen::Matrix<double, 3, 9> J_both;
  J_both << PointAnchorJacobian(anchor, theta), J;
  return Symmetrised(J_both * PathWindow::WithAnchor(InputOf(particle), track, particle.path, theta) *
                     J_both.transpose());
}

// Over particles: each has the landmark as a Gaussian on its own path. In the start's window these are the first one's, turned.
std::vector<std::optional<PointMoments>> ParticleFilter::LandmarkPoints() const {
  std::vector<std::optional<PointMoments>> points;
  const std::vector<Track> tracks = TrackOfEach();
  for (int n = 0; n < landmark_count(); ++n) {
    PointMixture mixture;
    Eigen::Matrix3d first = Eigen::Matrix3d::Zero();
    bool in_front = true;
    if (together() && ModeOf(particles_[0], n).z() > 0) first = PointCovariance(particles_[0], tracks[n]);
    for (std::size_t i = 0; i < particles_.size() && in_front; ++i) {
      if (weights_[i] == 0) continue;
      const Particle& particle = particles_[i];
      const Pose& anchor = particle.anchors[anchor_of_[n]];
      const Eigen::Vector3d& theta = ModeOf(particle, n);
      in_front = theta.z() > 0;
      if (!in_front) break;
      const Eigen::Matrix3d turn = (particle.pose.q_WC * particles_[0].pose.q_WC.conjugate()).toRotationMatrix();
      mixture.Add(weights_[i], PointInWorld(anchor, theta),
                  together() ? Eigen::Matrix3d(turn * first * turn.transpose()) : PointCovariance(particle, tracks[n]));
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
