// ParticleFilter with lag > 0: algorithm, section 9. Poses stay Gaussian for a while; the oldest of them is sampled once the images
// after it have spoken, and only then are the velocity and the landmarks updated with its frame. The start is such a window as well.

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "vo/filter/exact_draws.h"
#include "vo/filter/particle_filter.h"
#include "vo/filter/path_end.h"
#include "vo/filter/resampling.h"
#include "vo/geometry/symmetric.h"

namespace vo {
namespace {

// Equal weights: a particle is refuted when the window's images are exp(50) times less likely by it than by the best one. Where the model
// holds, the worst of 8 or of 64 particles was within 33 nats of the best in every frame; one in a wrong solution is hundreds away.
constexpr double kRefuted = 50;

// The start's window has to get anywhere from a first guess that may be far off; later ones begin at the solution of the frame before.
constexpr int kStartIterations = 50;
// And as long as nothing is sampled the next frame solves it all again: so far from the mode it may end [standard deviations].
constexpr double kStartLeft = 0.1;

}  // namespace

void ParticleFilter::PredictPath(double dt) {
  const int present = static_cast<int>(steps_.size()) - 1;
  const bool coasted = present >= 0 && steps_.back().matches.empty() &&
                       std::find(anchor_slot_.begin(), anchor_slot_.end(), present) == anchor_slot_.end();
  if (coasted) {  // a pose that nothing refers to: integrated out
    path_prior_.reset();
    dt += steps_.back().dt;
    steps_.pop_back();
    for (Particle& particle : particles_) {
      const auto left = static_cast<Eigen::Index>(kPoseSize * steps_.size());
      particle.path.mean.pop_back();
      particle.path.turns.pop_back();
      particle.path.covariance.conservativeResize(left, left);
    }
    if (!answered_.empty()) answered_.pop_back();
  }
  const auto prior = [this] {
    std::vector<MotionModel> models;
    for (const Step& step : steps_) models.push_back(NearlyConstantVelocity(motion_, step.dt));
    return PathPrior(models, particles_[0].velocity.covariance);
  };
  if (!path_prior_) path_prior_.emplace(prior());
  const MotionModel step = NearlyConstantVelocity(motion_, dt);
  for (Particle& particle : particles_)
    Extend(*path_prior_, step, particle.pose, particle.velocity.mean, particle.path);
  steps_.push_back({dt, frame_, {}});
  path_prior_.emplace(prior());
  BuildTracks();
  if (!undecided_) SolvePaths();  // what was drawn since has changed the rest
  for (Particle& particle : particles_)
    particle.prediction = {particle.path.mean.back(), particle.path.covariance.bottomRightCorner<6, 6>()};

  // The landmarks of the particle that outliers are told by.
  const Particle& heaviest = Heaviest();
  heaviest_landmarks_ = heaviest.landmarks;
  const WindowInput in{heaviest.pose, heaviest.velocity.mean, heaviest.landmarks, heaviest.anchors};
  for (const Track& track : tracks_)
    heaviest_landmarks_[track.landmark] =
        PathWindow::Smoothed(in, track, heaviest.path, heaviest.modes[track.landmark]);
}

void ParticleFilter::UpdatePath(std::span<const Match> matches) {
  if (!matches.empty()) {
    steps_.back().matches.assign(matches.begin(), matches.end());
    for (Particle& particle : particles_) particle.log_weight -= particle.path.log_evidence;
    if (tells_rows()) {
      SettleRows();
    } else {
      BuildTracks();
      SolvePaths();
    }
    if (undecided_) LookForBetter();
    for (Particle& particle : particles_) particle.log_weight += particle.path.log_evidence;
    for (const Particle& particle : Leaders()) guards_ += particle.path.guards;
  }
  mixture_.clear();
  for (const Particle& particle : particles_) mixture_.push_back(ComponentOnPath(particle));
  if (!matches.empty()) WeighPaths();
  Answer();
  if (together()) lengthened_ = Lengthened();
  answered_ = together() ? particles_[0].path.mean : std::vector<Pose>();
  const bool full = static_cast<int>(steps_.size()) > window_size();
  if (full && undecided_) Decide();
  // With equal weights a refuted particle is replaced before the draw, so that it is not the draws that are alike; and not before there is
  // one: until then all look for the best solution anyway.
  if (params_.weight == Weight::equal && full && ToResample()) Resample();
  if (full) CommitOldest(static_cast<int>(steps_.size()) - window_size());
  if (!delayed())
    for (Particle& particle : particles_) particle.modes.clear();
  if (params_.weight != Weight::equal && ToResample()) Resample();
}

Track::View ParticleFilter::ViewOf(const Match& match, int slot) {
  return {slot, match.z, match.R.inverse(), std::log(match.R.determinant()), match.moved};
}

void ParticleFilter::BuildTracks() {
  tracks_.clear();
  track_of_.assign(anchor_of_.size(), -1);
  for (int slot = 0; slot < static_cast<int>(steps_.size()); ++slot) {
    for (const Match& match : steps_[slot].matches) {
      int& index = track_of_[match.landmark];
      if (index < 0) {
        index = static_cast<int>(tracks_.size());
        const int anchor = anchor_of_[match.landmark];
        tracks_.push_back({match.landmark, anchor, anchor_slot_[anchor], {}});
      }
      tracks_[index].views.push_back(ViewOf(match, slot));
    }
  }
}

void ParticleFilter::SolvePaths() {
  for (Particle& particle : Leaders()) SolvePath(particle);
}

void ParticleFilter::SolvePath(Particle& particle, double beaten_by) {
  const int iterations = undecided_ ? std::max(params_.max_iterations, kStartIterations) : params_.max_iterations;
  const WindowOptions options{params_.proposal == Proposal::ekf ? 1 : iterations, params_.marginal_mode,
                              together() ? kStartLeft : kLeft, beaten_by};
  modes_.resize(tracks_.size());
  for (std::size_t i = 0; i < tracks_.size(); ++i) modes_[i] = particle.modes[tracks_[i].landmark];
  window_.Solve(*path_prior_, {particle.pose, particle.velocity.mean, particle.landmarks, particle.anchors}, tracks_,
                options, particle.path, modes_);
  for (std::size_t i = 0; i < tracks_.size(); ++i) particle.modes[tracks_[i].landmark] = modes_[i];
  PlaceAnchors(particle);
}

void ParticleFilter::PlaceAnchors(Particle& particle) const {
  for (std::size_t a = 0; a < particle.anchors.size(); ++a)
    if (anchor_slot_[a] >= 0) particle.anchors[a] = particle.path.mean[anchor_slot_[a]];
}

void ParticleFilter::WeighPaths() {
  if (params_.weight != Weight::equal) return Weigh();
  std::vector<double> log_evidence;
  for (const Particle& particle : particles_) log_evidence.push_back(particle.path.log_evidence);
  weights_ = EqualUnlessRefuted(log_evidence, kRefuted);
  ReplaceImpossible();
  effective_particles_ = EffectiveParticles(weights_);
}

// Equal weights: whenever a particle is refuted, another takes its place.
bool ParticleFilter::ToResample() const {
  if (params_.weight == Weight::equal) return std::find(weights_.begin(), weights_.end(), 0.0) != weights_.end();
  return effective_particles_ < params_.resample_below * params_.particles;
}

void ParticleFilter::CommitOldest(int count) {
  for (int k = 0; k < count; ++k) {
    const std::vector<Pose> drawn = Draw(k);
    for (std::size_t i = 0; i < particles_.size(); ++i) Fix(particles_[i], k, drawn[i]);
  }
  for (Particle& particle : particles_) {
    if (count > 1)
      Triangulate(particle);  // the draws of many poses together go far
    else
      PlaceAnchors(particle);
  }
  for (int k = 0; k < count; ++k) {
    const MotionModel model = NearlyConstantVelocity(motion_, steps_[k].dt);
    step_ = {model.F, model.Q};
    for (std::uint32_t i = 0; i < particles_.size(); ++i) UpdateGiven(particles_[i], k, i);
  }
  for (Particle& particle : particles_) {
    particle.path.mean.erase(particle.path.mean.begin(), particle.path.mean.begin() + count);
    particle.path.turns.erase(particle.path.turns.begin(), particle.path.turns.begin() + count);
  }
  for (int& slot : anchor_slot_) slot = std::max(slot - count, -1);
  steps_.erase(steps_.begin(), steps_.begin() + count);
  path_prior_.reset();
}

// The poses before are drawn: the path's covariance is that of the rest.
std::vector<Pose> ParticleFilter::Draw(int slot) const {
  ParticleColumns offsets(6, params_.particles), normals(6, params_.particles);
  for (std::uint32_t i = 0; i < particles_.size(); ++i) {
    offsets.col(i) = Minus(particles_[i].path.mean[slot], particles_[0].path.mean[slot]);
    normals.col(i) = NormalVector<Vector6>({seed_, Stream::pose, steps_[slot].frame, i});
  }
  if (params_.weight == Weight::equal && EnoughForExactDraws(params_.particles, 6))
    normals = ExactDraws(offsets, normals);
  std::vector<Pose> drawn;
  for (std::uint32_t i = 0; i < particles_.size(); ++i) {
    const PathGaussian& path = particles_[i].path;
    drawn.push_back(PoseGaussian{path.mean[slot], path.covariance.topLeftCorner<6, 6>()}.Displaced(normals.col(i)));
  }
  return drawn;
}

// The rest of the path, given the pose.
void ParticleFilter::Fix(Particle& particle, int slot, const Pose& s) {
  PathGaussian& path = particle.path;
  const int rest = static_cast<int>(path.covariance.rows()) - 6;
  const Eigen::LLT<Matrix6> llt(path.covariance.topLeftCorner<6, 6>());
  const Vector6 d = llt.solve(Minus(s, path.mean[slot]));
  const Eigen::MatrixXd cross = path.covariance.bottomLeftCorner(rest, 6);
  for (int k = 0; k < rest / 6; ++k)
    path.mean[slot + 1 + k] = Plus(path.mean[slot + 1 + k], cross.middleRows<6>(kPoseSize * k) * d);
  path.mean[slot] = s;
  path.covariance = (path.covariance.bottomRightCorner(rest, rest) - cross * llt.solve(cross.transpose())).eval();
}

void ParticleFilter::UpdateGiven(Particle& particle, int slot, std::uint32_t index) const {
  const Pose& s = particle.path.mean[slot];
  UpdateVelocity(particle, s, particle.path.turns[slot], VelocityGiven(particle), index);  // (37)-(43)
  UpdateLandmarksAt(slot, particle, particle.landmarks);
  particle.pose = s;
}

// The landmarks given one pose of the particle's path and what was seen from it.
void ParticleFilter::UpdateLandmarksAt(int slot, const Particle& particle, std::vector<Landmark>& landmarks) const {
  const std::vector<AnchorView> views = ViewsOf(particle.anchors, particle.path.mean[slot]);
  for (const Match& match : steps_[slot].matches) {
    const AnchorView view = views[anchor_of_[match.landmark]].From(match.moved);
    Landmark& landmark = landmarks[match.landmark];
    landmark = UpdateLandmark(landmark, particle.modes[match.landmark], view, match, 1).landmark;
  }
}

BeliefComponent ParticleFilter::ComponentOnPath(const Particle& particle) const {
  const PathGaussian& path = particle.path;
  const LastVelocity last = VelocityAtTheEnd(*path_prior_, particle.pose, particle.velocity.mean, path);
  BeliefComponent component;
  component.pose = path.mean.back();
  component.velocity = last.mean;
  const Eigen::Matrix<double, 6, Eigen::Dynamic> cross = last.by_pose * path.covariance;
  component.covariance.topLeftCorner<6, 6>() = path.covariance.bottomRightCorner<6, 6>();
  component.covariance.bottomLeftCorner<6, 6>() = cross.rightCols<6>();
  component.covariance.topRightCorner<6, 6>() = cross.rightCols<6>().transpose();
  component.covariance.bottomRightCorner<6, 6>() =
      path_prior_->last_covariance() + Symmetrised(cross * last.by_pose.transpose());
  return component;
}

std::vector<ImagePrediction> ParticleFilter::PredictImagesOnPath(std::span<const int> landmarks) const {
  const std::size_t leaders = together() ? 1 : particles_.size();
  std::vector<ImagePrediction> predictions;
  for (const int landmark : landmarks) {
    const int anchor = anchor_of_[landmark];
    const Track untracked{landmark, anchor, anchor_slot_[anchor], {}};
    const Track& track = track_of_[landmark] < 0 ? untracked : tracks_[track_of_[landmark]];
    ImageMoments moments;
    for (std::size_t i = 0; i < leaders; ++i) {
      const Particle& particle = particles_[i];
      const WindowInput in{particle.pose, particle.velocity.mean, particle.landmarks, particle.anchors};
      const ImagePrediction one = PathWindow::PredictLast(in, track, particle.path, particle.modes[landmark]);
      if (!one.in_front) continue;
      const double weight = together() ? 1 : weights_[i];
      moments.weight += weight;
      moments.z += weight * one.z;
      moments.second += weight * (one.z * one.z.transpose() + one.covariance);
    }
    predictions.push_back(moments.Prediction());
  }
  return predictions;
}

}  // namespace vo
