// Landmarks of a window phase: new and dropped ones, the reference of the outlier test, predicted images, spreads over
// the particles.
#include <algorithm>
#include <cmath>

#include "vo/filter/window_phase.h"
#include "vo/geometry/covariance.h"

namespace vo {

void WindowPhase::AddLandmarks(std::span<const FirstView> views) {
  if (views.empty()) return;
  const int anchor = AppendLandmarks(views);
  for (Particle& particle : particles_) {
    particle.anchors[anchor] = window_.size() == 0 ? particle.pose : particle.solution.path.mean.back();
    for (std::size_t n = particle.landmarks.size() - views.size(); n < particle.landmarks.size(); ++n)
      particle.solution.modes.push_back(particle.landmarks[n].mean);
  }
  first_views_.insert(first_views_.end(), views.begin(), views.end());
  window_.AddAnchor(anchor, table_);
}

void WindowPhase::KeepLandmarks(const std::vector<bool>& keep) {
  window_.Keep(CompactLandmarks(keep), table_);
  Compact(keep, first_views_);
  for (Particle& particle : particles_) Compact(keep, particle.solution.modes);
}

// Rows referred to their frames' stamps anew, by the velocities through both neighbours, where images have seen these.
void WindowPhase::CorrectRows(SlotRange slots, bool rates) {
  const std::size_t heaviest = particles_.Heaviest();
  CorrectedWindow corrected =
      CorrectShutter(window_, table_, first_views_, InputOf(heaviest), particles_[heaviest].solution, slots,
                     ShutterReference::row_pose, rates, settings_.landmark);
  window_ = std::move(corrected.window);
  for (int n = 0; n < table_.size(); ++n)
    if (slots.contains(window_.anchor_slot(table_.anchor_of(n))))
      for (Particle& particle : particles_) particle.landmarks[n] = corrected.landmarks[n];
}

bool WindowPhase::rolling() const {
  return std::ranges::any_of(first_views_, [](const FirstView& view) { return view.row.time != 0; });
}

void WindowPhase::SetReference() {
  const std::size_t heaviest = particles_.Heaviest();
  reference_.given_path.resize(static_cast<std::size_t>(table_.size()));
  for (int n = 0; n < table_.size(); ++n) reference_.given_path[n] = {particles_[heaviest].landmarks[n].covariance, {}};
  reference_.landmarks = particles_[heaviest].landmarks;
  for (const Track& track : window_.tracks()) {
    const int n = track.landmark;
    reference_.given_path[n] = OnPath(heaviest, track).GivenPath();
    reference_.landmarks[n] = {particles_[heaviest].solution.modes[n], reference_.given_path[n].P};
  }
}

// The covariances given the sampled path are nearly the same for all particles: those of the heaviest stand for all.
std::vector<ImagePrediction> WindowPhase::PredictImages(std::span<const int> landmarks) const {
  const std::span<const double> weights = SolutionWeights();
  const std::size_t heaviest = particles_.Heaviest();
  const Eigen::MatrixXd& P = particles_[heaviest].solution.path.covariance;
  std::vector<Eigen::Matrix3d> R_CW;
  for (std::size_t i = 0; i < weights.size(); ++i)
    R_CW.push_back(particles_[i].solution.path.mean.back().q_WC.conjugate().toRotationMatrix());
  std::vector<Track> tracks;
  std::vector<Projection> images;
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(2 * static_cast<Eigen::Index>(landmarks.size()), P.cols());
  for (std::size_t k = 0; k < landmarks.size(); ++k) {
    tracks.push_back(window_.TrackOf(landmarks[k], table_));
    images.push_back(OnPath(heaviest, tracks[k]).Image(reference_.given_path[landmarks[k]], J.middleRows<2>(2 * k)));
  }
  const Eigen::MatrixXd JP = J * P;
  std::vector<ImagePrediction> predictions;
  for (std::size_t k = 0; k < landmarks.size(); ++k) {
    const int n = landmarks[k];
    ImageMoments moments;
    const Eigen::Matrix2d covariance =
        Symmetrised(JP.middleRows<2>(2 * k).lazyProduct(J.middleRows<2>(2 * k).transpose()) +
                    images[k].J_landmark * reference_.given_path[n].P * images[k].J_landmark.transpose());
    for (std::size_t i = 0; images[k].in_front && i < weights.size(); ++i) {
      const PathSolution& solution = particles_[i].solution;
      const Pose& anchor = AnchorOn(solution.path, InputOf(i), tracks[k]);
      const Eigen::Vector3d X = ScaledPoint(R_CW[i], solution.path.mean.back().p_WC, anchor, solution.modes[n]);
      moments.Add(weights[i], {X.z() > kMinDepth, X.head<2>() / X.z(), covariance});
    }
    predictions.push_back(moments.Prediction());
  }
  return predictions;
}

ReferencePath WindowPhase::Reference() const {
  const std::size_t heaviest = particles_.Heaviest();
  const PathSolution& solution = particles_[heaviest].solution;
  LocalMap map = MapOf(heaviest);
  map.landmarks = reference_.landmarks;
  return {{solution.path.mean.back(), solution.path.covariance.bottomRightCorner<6, 6>()}, map, solution.modes};
}

std::vector<Filter::LandmarkSpread> WindowPhase::LandmarkSpreads() const {
  const std::span<const double> weights = SolutionWeights();
  std::vector<LandmarkSpread> spreads = ParticlePhase::LandmarkSpreads();
  for (int n = 0; n < table_.size(); ++n) {
    const Track track = window_.TrackOf(n, table_);
    double mean = 0, square = 0;  // about the first particle's
    for (std::size_t i = 0; i < weights.size(); ++i) {
      if (weights[i] == 0) continue;
      const double off = particles_[i].solution.modes[n].z() - particles_[0].solution.modes[n].z();
      mean += weights[i] * off;
      square += weights[i] * (OnPath(i, track).WithAnchor()(8, 8) + off * off);
    }
    spreads[n].inverse_depth_sigma = std::sqrt(square - mean * mean);
  }
  return spreads;
}

Eigen::Matrix3d WindowPhase::PointCovariance(std::size_t particle, int landmark) const {
  return OnPath(particle, window_.TrackOf(landmark, table_)).PointCovariance();
}

std::vector<Eigen::Matrix3d> WindowPhase::PointCovariances(int landmark) const {
  std::vector<Eigen::Matrix3d> covariances(particles_.size(), Eigen::Matrix3d::Zero());
  for (std::size_t i = 0; i < particles_.size(); ++i)
    if (particles_.weights()[i] != 0) covariances[i] = PointCovariance(i, landmark);
  return covariances;
}

}  // namespace vo
