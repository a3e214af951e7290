#include "vo/filter/particle_filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "vo/filter/exact_draws.h"
#include "vo/filter/mixture.h"
#include "vo/filter/resampling.h"
#include "vo/filter/unscented_proposal.h"
#include "vo/geometry/so3.h"

namespace vo {
namespace {

CameraVelocityFilter StepOf(const MotionParams& motion, double dt) {
  const MotionModel model = NearlyConstantVelocity(motion, dt);
  return {model.F, model.Q};
}

// s_pf as the velocity filter sees it: position, and the rotation since the last sampled pose (section 4), which was predicted to be `turn`.
Vector6 PathState(const Pose& pose, const Pose& previous, const Eigen::Vector3d& turn) {
  Vector6 s;
  s << pose.p_WC, LogNear(previous.q_WC.conjugate() * pose.q_WC, turn);
  return s;
}
Vector6 PathState(const Pose& pose) { return PathState(pose, pose, Eigen::Vector3d::Zero()); }

bool KnowsWindows(const FilterParams& params) {
  return params.sampled == Sampled::pose &&
         (params.proposal == Proposal::ekf || params.proposal == Proposal::iterated) &&
         params.weight != Weight::importance;
}

UnscentedParams UnscentedOf(const FilterParams& params) {
  return {params.ukf_alpha, params.ukf_beta, params.ukf_kappa};
}

}  // namespace

ParticleFilter::ParticleFilter(const MotionParams& motion, const FilterParams& filter, const LandmarkParams& landmark,
                               const FilterPrior& prior, std::uint64_t seed)
    : motion_(motion),
      params_(filter),
      landmark_params_(landmark),
      seed_(seed),
      step_(StepOf(motion, 1.0)),
      particles_(filter.particles),
      weights_(filter.particles, 1.0 / filter.particles),
      start_window_(KnowsWindows(filter) ? filter.start_window : 0),
      undecided_(std::max(filter.lag, start_window_) > 0),
      effective_particles_(filter.particles) {
  for (std::uint32_t i = 0; i < particles_.size(); ++i) {
    Particle& particle = particles_[i];
    particle.pose = prior.pose.Sample({seed_, Stream::prior_pose, 0, i});
    particle.velocity = {prior.velocity, prior.velocity_covariance};
    if (params_.sampled == Sampled::pose_and_velocity)
      particle.velocity = {
          SampleNormal(prior.velocity, prior.velocity_covariance, {seed_, Stream::prior_velocity, 0, i}),
          Matrix6::Zero()};
  }
  belief_.pose = prior.pose.mean;
  belief_.velocity = prior.velocity;
  belief_.covariance.topLeftCorner<6, 6>() = prior.pose.covariance;
  belief_.covariance.bottomRightCorner<6, 6>() = prior.velocity_covariance;
}

void ParticleFilter::Predict(double dt) {
  ++frame_;
  guards_ = {};
  lengthened_ = 1;
  if (delayed()) return PredictPath(dt);
  since_sampled_ += dt;
  step_ = StepOf(motion_, since_sampled_);
  const Matrix6 covariance = step_.PredictedCovariance(particles_[0].velocity);  // (13)
  for (Particle& particle : particles_) particle.prediction = PredictPose(particle, covariance);
}

void ParticleFilter::Update(std::span<const Match> matches) {
  if (delayed())
    UpdatePath(matches);
  else if (matches.empty())
    Coast();
  else
    SampleStep(matches);
}

void ParticleFilter::Coast() {
  mixture_.clear();
  CameraVelocityFilter::Gain gain = step_.ConditionCovariance(particles_[0].velocity.covariance);
  for (const Particle& particle : particles_) {
    step_.ConditionMean(PathState(particle.pose), particle.velocity.mean, gain);
    mixture_.push_back(Component(particle.prediction, particle.pose, PredictedTurn(particle), gain));
  }
  Answer();
}

void ParticleFilter::SampleStep(std::span<const Match> matches) {
  mixture_.clear();
  batch_.SetMatches(matches);
  CameraVelocityFilter::Gain gain = step_.ConditionCovariance(particles_[0].velocity.covariance);
  for (std::uint32_t i = 0; i < particles_.size(); ++i) {  // line 1
    Particle& particle = particles_[i];
    const PoseGaussian& prediction = particle.prediction;          // 2, (12)(13)
    const PoseProposal proposal = ProposePose(particle, matches);  // (15)(16)
    guards_ += proposal.guards;
    const Pose s = proposal.pose.Sample({seed_, Stream::pose, frame_, i});  // 4
    // The motion model knows nothing of the image: what is believed then is the weighted samples themselves.
    const PoseGaussian believed =
        params_.proposal == Proposal::bootstrap ? PoseGaussian{s, Matrix6::Zero()} : proposal.pose;
    step_.ConditionMean(PathState(particle.pose), particle.velocity.mean, gain);
    const Eigen::Vector3d turn = PredictedTurn(particle);
    mixture_.push_back(Component(believed, particle.pose, turn, gain));
    UpdateVelocity(particle, s, turn, gain, i);  // 5-7, (37)-(43)
    const double log_likelihood = UpdateLandmarks(particle, s, matches);
    particle.log_weight += params_.weight == Weight::evidence  // 8
                               ? proposal.log_evidence
                               : prediction.LogDensity(s) + log_likelihood - proposal.pose.LogDensity(s);  // (17)
    particle.pose = s;
  }
  since_sampled_ = 0;
  Weigh();
  Answer();
  if (effective_particles_ < params_.resample_below * params_.particles) Resample();  // 11
}

PoseGaussian ParticleFilter::PredictPose(const Particle& particle, const Matrix6& covariance) const {
  const Vector6 s = step_.PredictedMean(PathState(particle.pose), particle.velocity);  // (12)
  const Pose mean{s.head<3>(), (particle.pose.q_WC * Exp(s.tail<3>())).normalized()};
  // (13) is a covariance of delta, about delta-hat; the tangent space at the mean is turned by the right Jacobian.
  Matrix6 J = Matrix6::Identity();
  J.bottomRightCorner<3, 3>() = RightJacobian(s.tail<3>());
  return {mean, J * covariance * J.transpose()};
}

Eigen::Vector3d ParticleFilter::PredictedTurn(const Particle& particle) const {
  return step_.PredictedMean(PathState(particle.pose), particle.velocity).tail<3>();
}

PoseProposal ParticleFilter::ProposePose(const Particle& particle, std::span<const Match> matches) {
  batch_.Load(MapOf(particle));
  if (matches.empty()) return {particle.prediction, 0, {}};
  switch (params_.proposal) {
    case Proposal::bootstrap:
      return {particle.prediction, 0, {}};
    case Proposal::ukf:
      return ProposeUnscented(particle.prediction, MapOf(particle), matches, UnscentedOf(params_));
    case Proposal::ekf:
    case Proposal::iterated:
      break;
  }
  return Propose(particle.prediction, batch_, params_);
}

CameraVelocityFilter::Gain ParticleFilter::VelocityGiven(const Particle& particle) const {
  return step_.Condition(PathState(particle.pose), particle.velocity);
}

void ParticleFilter::UpdateVelocity(Particle& particle, const Pose& pose, const Eigen::Vector3d& turn,
                                    const CameraVelocityFilter::Gain& gain, std::uint32_t index) const {
  particle.velocity = gain.Given(PathState(pose, particle.pose, turn));
  // RB-PF: the velocity is sampled as well, from its exact conditional; this leaves the weight as it is.
  if (params_.sampled == Sampled::pose_and_velocity)
    particle.velocity = {
        SampleNormal(particle.velocity.mean, particle.velocity.covariance, {seed_, Stream::velocity, frame_, index}),
        Matrix6::Zero()};
}

double ParticleFilter::UpdateLandmarks(Particle& particle, const Pose& pose, std::span<const Match> matches) {
  double log_likelihood = 0;
  if (params_.proposal == Proposal::ukf) {
    for (const Match& match : matches) {
      Landmark& landmark = particle.landmarks[match.landmark];
      const AnchorView view(pose, particle.anchors[anchor_of_[match.landmark]]);
      const LandmarkUpdate update =
          UpdateLandmarkUnscented(landmark, view.From(match.moved), match, UnscentedOf(params_));
      landmark = update.landmark;
      log_likelihood += update.log_likelihood;
    }
  } else if (!matches.empty()) {
    if (params_.proposal == Proposal::iterated) batch_.Follow(Minus(pose, batch_.linearised_at()));
    log_likelihood = batch_.UpdateLandmarks(pose, params_.proposal == Proposal::ekf ? 1 : params_.max_iterations);
    batch_.Store(particle.landmarks);
  }
  return log_likelihood;
}

void ParticleFilter::Weigh() {
  for (std::size_t i = 0; i < particles_.size(); ++i) weights_[i] = particles_[i].log_weight;
  const double peak = Normalise(weights_);
  for (Particle& particle : particles_) particle.log_weight -= peak;
  ReplaceImpossible();
  effective_particles_ = EffectiveParticles(weights_);
}

// A particle whose evidence is not a number stands for nothing: it has no weight by now, and gives its place to the heaviest. Where there is
// no other, all begin to be weighed again; WatchedFilter says whether there is an answer.
void ParticleFilter::ReplaceImpossible() {
  const std::size_t heaviest = static_cast<std::size_t>(&Heaviest() - particles_.data());
  const bool any_possible = std::isfinite(particles_[heaviest].log_weight);
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    if (std::isfinite(particles_[i].log_weight)) continue;
    ++guards_.impossible;
    if (!any_possible) {
      particles_[i].log_weight = particles_[i].path.log_evidence = 0;
      continue;
    }
    particles_[heaviest].log_weight -= std::numbers::ln2;
    weights_[i] = weights_[heaviest] *= 0.5;
    particles_[i] = particles_[heaviest];
    mixture_[i] = mixture_[heaviest];
  }
}

void ParticleFilter::Answer() {
  for (std::size_t i = 0; i < mixture_.size(); ++i) mixture_[i].weight = weights_[i];
  belief_ = Moments(mixture_);
}

void ParticleFilter::Resample() {
  SystematicAncestors(weights_, Uniform({seed_, Stream::resampling, frame_, 0}, 0), ancestors_);
  children_.resize(particles_.size());
  int childless = 0;
  for (std::size_t i = 0; i < ancestors_.size(); ++i) {  // they ascend
    Particle& parent = particles_[ancestors_[i]];
    const bool last = i + 1 == ancestors_.size() || ancestors_[i + 1] != ancestors_[i];
    if (last) {
      std::swap(children_[i], parent);
    } else {  // a copy, in the memory of one that has no child
      while (std::binary_search(ancestors_.begin(), ancestors_.end(), childless)) ++childless;
      std::swap(children_[i], particles_[childless++]);
      children_[i] = parent;
    }
    children_[i].log_weight = 0;
  }
  particles_.swap(children_);
  weights_.assign(weights_.size(), 1.0 / static_cast<double>(weights_.size()));
}

void ParticleFilter::AddLandmarks(std::span<const FirstView> views) {
  if (views.empty()) return;
  if (!delayed() && since_sampled_ > 0) SampleStep({});
  // The slot of an anchor that no landmark uses any more is used again, so that long runs stay small.
  const int slots = static_cast<int>(particles_[0].anchors.size());
  std::vector<bool> used(slots, false);
  for (const int anchor : anchor_of_) used[anchor] = true;
  const int slot = static_cast<int>(std::find(used.begin(), used.end(), false) - used.begin());
  for (Particle& particle : particles_) {
    if (slot == slots) particle.anchors.emplace_back();
    particle.anchors[slot] = steps_.empty() ? particle.pose : particle.path.mean.back();
    for (const FirstView& view : views) {
      particle.landmarks.push_back(NewLandmark(view, landmark_params_));
      if (delayed()) particle.modes.push_back(particle.landmarks.back().mean);
    }
  }
  if (together()) {
    rolling_ = rolling_ || std::any_of(views.begin(), views.end(), [](const FirstView& v) { return v.row.time != 0; });
    first_views_.insert(first_views_.end(), views.begin(), views.end());
  }
  if (slot == slots) anchor_slot_.emplace_back();
  anchor_slot_[slot] = static_cast<int>(steps_.size()) - 1;
  anchor_of_.insert(anchor_of_.end(), views.size(), slot);
}

void ParticleFilter::KeepLandmarks(const std::vector<bool>& keep) {
  const auto compact = [&](auto& items) {
    std::size_t to = 0;
    for (std::size_t from = 0; from < items.size(); ++from)
      if (keep[from]) items[to++] = items[from];
    items.resize(to);
  };
  for (Particle& particle : particles_) {
    compact(particle.landmarks);
    if (delayed()) compact(particle.modes);
  }
  compact(anchor_of_);
  if (together()) compact(first_views_);
  std::vector<int> index(keep.size(), -1);
  for (int from = 0, to = 0; from < static_cast<int>(keep.size()); ++from)
    if (keep[from]) index[from] = to++;
  for (Step& step : steps_) {
    std::erase_if(step.matches, [&](const Match& match) { return index[match.landmark] < 0; });
    for (Match& match : step.matches) match.landmark = index[match.landmark];
  }
}

std::vector<ImagePrediction> ParticleFilter::PredictImages(std::span<const int> landmarks) const {
  if (delayed()) return PredictImagesOnPath(landmarks);
  MatchBatch batch;
  batch.SetLandmarks(landmarks);
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    batch.Load(MapOf(particles_[i]));
    batch.AddPredictions(particles_[i].prediction.mean, particles_[i].prediction.covariance, weights_[i]);
  }
  std::vector<ImagePrediction> predictions;
  for (std::size_t i = 0; i < landmarks.size(); ++i) predictions.push_back(batch.Moments(i).Prediction());
  return predictions;
}

const Particle& ParticleFilter::Heaviest() const {
  return particles_[std::max_element(weights_.begin(), weights_.end()) - weights_.begin()];
}

LocalMap ParticleFilter::ReferenceMap() const {
  LocalMap map = MapOf(Heaviest());
  if (delayed()) map.landmarks = heaviest_landmarks_;
  return map;
}

std::vector<Filter::LandmarkBelief> ParticleFilter::LandmarkBeliefs() const {
  const Particle& best = Heaviest();
  std::vector<LandmarkBelief> beliefs;
  for (int n = 0; n < landmark_count(); ++n)
    beliefs.push_back({PointInWorld(best.anchors[anchor_of_[n]], ModeOf(best, n)), 0, 0});
  for (std::size_t i = 0; i < particles_.size(); ++i)
    for (std::size_t n = 0; n < beliefs.size(); ++n)
      beliefs[n].inverse_depth += weights_[i] * ModeOf(particles_[i], static_cast<int>(n)).z();
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    for (std::size_t n = 0; n < beliefs.size(); ++n) {
      const double off = ModeOf(particles_[i], static_cast<int>(n)).z() - beliefs[n].inverse_depth;
      beliefs[n].inverse_depth_sigma +=
          weights_[i] * (particles_[i].landmarks[n].covariance(2, 2) + off * off);  // the variance, so far
    }
  }
  for (LandmarkBelief& belief : beliefs) belief.inverse_depth_sigma = std::sqrt(belief.inverse_depth_sigma);
  return beliefs;
}

}  // namespace vo
