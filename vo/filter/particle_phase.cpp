#include "vo/filter/particle_phase.h"

#include <cmath>

#include "vo/base/instruction_set.h"
#include "vo/geometry/covariance.h"

namespace vo {

ParticlePhase::ParticlePhase(const ParticleFilterSettings& settings, const FilterPrior& prior)
    : settings_(settings), particles_(settings.filter.particles) {
  FixBlocksOfProducts();
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    Particle& particle = particles_[i];
    particle.pose = prior.pose.Sample(Key(Stream::prior_pose, i));
    particle.velocity = {prior.velocity, prior.velocity_covariance};
    if (settings.filter.sampled == Sampled::pose_and_velocity)
      particle.velocity = {SampleNormal(prior.velocity, prior.velocity_covariance, Key(Stream::prior_velocity, i)),
                           Matrix6::Zero()};
  }
  answer_.belief.pose = prior.pose.mean;
  answer_.belief.velocity = prior.velocity;
  answer_.belief.covariance.topLeftCorner<6, 6>() = prior.pose.covariance;
  answer_.belief.covariance.bottomRightCorner<6, 6>() = prior.velocity_covariance;
  answer_.effective_particles = settings.filter.particles;
}

void ParticlePhase::BeginFrame() {
  ++frame_;
  answer_.events = {};
  answer_.scale_change = 1;
  answer_.start.clear();
}

int ParticlePhase::AppendLandmarks(std::span<const FirstView> views) {
  const int anchor = table_.Add(static_cast<int>(views.size()));
  for (Particle& particle : particles_) {
    particle.anchors.resize(table_.anchor_count());
    for (const FirstView& view : views) particle.landmarks.push_back(NewLandmark(view, settings_.landmark));
  }
  return anchor;
}

std::vector<int> ParticlePhase::CompactLandmarks(const std::vector<bool>& keep) {
  for (Particle& particle : particles_) Compact(keep, particle.landmarks);
  return table_.Keep(keep);
}

std::vector<bool> ParticlePhase::MovingAnchors(int first_landmark) const {
  std::vector<bool> moves(static_cast<std::size_t>(table_.anchor_count()), false);
  for (int n = first_landmark; n < table_.size(); ++n)
    if (first_landmark == 0 || table_.anchor_of(n) != table_.anchor_of(first_landmark - 1))
      moves[table_.anchor_of(n)] = true;
  return moves;
}

void ParticlePhase::Move(const Correction& correction) {
  const std::vector<bool> moves = MovingAnchors(correction.first_landmark);
  const Eigen::Matrix3d R = correction.motions[particles_.Heaviest()].q_WC.toRotationMatrix();
  Matrix6 P = particles_[0].velocity.covariance;  // v is in W, w in C
  P.topRows<3>() = R * P.topRows<3>();
  P.leftCols<3>() *= R.transpose();
  P = Symmetrised(P);
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    Particle& particle = particles_[i];
    const Pose& M = correction.motions[i];
    particle.pose = M * particle.pose;
    particle.velocity.mean.head<3>() = M.q_WC * particle.velocity.mean.head<3>();
    particle.velocity.covariance = P;  // the same for all
    for (std::size_t a = 0; a < moves.size(); ++a)
      if (moves[a]) particle.anchors[a] = M * particle.anchors[a];
  }
}

void ParticlePhase::Record(const ParticleSet::Replacement& replaced) {
  answer_.events.non_finite_weight += static_cast<int>(replaced.particles.size());
  if (replaced.by < 0) return;
  for (const int i : replaced.particles) answer_.mixture[i] = answer_.mixture[replaced.by];
}

void ParticlePhase::FinishAnswer() {
  for (std::size_t i = 0; i < answer_.mixture.size(); ++i) answer_.mixture[i].weight = particles_.weights()[i];
  answer_.belief = Moments(answer_.mixture);
}

std::vector<Filter::LandmarkBelief> ParticlePhase::LandmarkBeliefs() const {
  const std::vector<double>& weights = particles_.weights();
  const std::size_t heaviest = particles_.Heaviest();
  std::vector<Modes> modes;  // per particle
  for (std::size_t i = 0; i < weights.size(); ++i) modes.push_back(ModesOf(i));
  std::vector<LandmarkBelief> beliefs;
  for (int n = 0; n < table_.size(); ++n) {
    double mean = 0, variance = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) mean += weights[i] * modes[i](2, n);
    for (std::size_t i = 0; i < weights.size(); ++i) {
      const double off = modes[i](2, n) - mean;
      variance += weights[i] * (particles_[i].landmarks[n].covariance(2, 2) + off * off);
    }
    beliefs.push_back({PointInWorld(AnchorOf(heaviest, n), modes[heaviest].col(n)), mean, std::sqrt(variance)});
  }
  return beliefs;
}

std::vector<Filter::LandmarkSpread> ParticlePhase::LandmarkSpreads() const {
  const std::vector<double>& weights = particles_.weights();
  std::vector<LandmarkSpread> spreads;
  for (const LandmarkBelief& belief : LandmarkBeliefs()) {
    const int n = static_cast<int>(spreads.size());
    spreads.push_back({belief.inverse_depth_sigma, std::nullopt});
    bool in_front = true;
    for (std::size_t i = 0; i < weights.size(); ++i) in_front = in_front && (weights[i] == 0 || ModesOf(i)(2, n) > 0);
    if (!in_front) continue;
    const std::vector<Eigen::Matrix3d> covariances = PointCovariances(n);
    PointMixture mixture;
    for (std::size_t i = 0; i < weights.size(); ++i)
      if (weights[i] != 0) mixture.Add(weights[i], PointInWorld(AnchorOf(i, n), ModesOf(i).col(n)), covariances[i]);
    spreads.back().place = mixture.Moments();
  }
  return spreads;
}

}  // namespace vo
