#include "vo/filter/algorithm1.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "vo/filter/unscented_proposal.h"

namespace vo {
namespace {

UnscentedParams Spread(const FilterParams& params) { return {params.ukf_alpha, params.ukf_beta, params.ukf_kappa}; }

}  // namespace

Algorithm1::Algorithm1(const ParticleFilterSettings& settings, const FilterPrior& prior)
    : ParticlePhase(settings, prior), step_(settings.motion, 1.0), predictions_(particles_.size()) {}

Algorithm1::Algorithm1(ParticlePhase&& finished)
    : ParticlePhase(std::move(finished)), step_(settings_.motion, 1.0), predictions_(particles_.size()) {
  for (Particle& particle : particles_) particle.solution = {};  // large, and not read again
}

void Algorithm1::Predict(double dt, const MotionInput& input) {
  BeginFrame();
  since_sampled_ += dt;
  correction_ = {};
  PredictAgain(input);
}

void Algorithm1::PredictAgain(const MotionInput& input) {
  if (!correction_.motions.empty()) {
    for (Pose& motion : correction_.motions) motion = Inverse(motion);
    Move(std::exchange(correction_, {}));
  }
  step_ = {settings_.motion, since_sampled_, input};
  turn_ = input.turn;
  PredictParticles();  // line 2
  if (!input.correction) return;
  for (const PoseGaussian& prediction : predictions_)
    correction_.motions.push_back(input.correction->pose * Inverse(prediction.mean));
  correction_.first_landmark = input.correction->first_landmark;
  Move(correction_);
  PredictParticles();
}

PoseGaussian Algorithm1::PredictionOf(const Pose& pose, const VelocityFilter::State& velocity,
                                      const Matrix6& covariance) const {
  PoseGaussian predicted = PredictPose(step_, pose, velocity, covariance);
  if (turn_) predicted.mean.q_WC = (pose.q_WC * *turn_).normalized();
  return predicted;
}

void Algorithm1::PredictParticles() {
  const Matrix6 covariance = step_.PredictedCovariance(particles_[0].velocity);  // (13), the same for all particles
  for (std::size_t i = 0; i < particles_.size(); ++i)
    predictions_[i] = PredictionOf(particles_[i].pose, particles_[i].velocity, covariance);
}

const FilterAnswer& Algorithm1::Update(std::span<const Match> z) { return z.empty() ? Coast() : SampleStep(z); }

const FilterAnswer& Algorithm1::SampleStep(std::span<const Match> matches) {
  const FilterParams& params = settings_.filter;
  answer_.mixture.clear();
  matches_.acting.clear();
  matches_.provisional.clear();
  std::ranges::partition_copy(matches, std::back_inserter(matches_.provisional), std::back_inserter(matches_.acting),
                              &Match::provisional);
  const std::span<const Match> z(matches_.acting);
  matches_.batch.SetMatches(z);
  matches_.provisional_batch.SetMatches(matches_.provisional);
  VelocityFilter::Gain gain = step_.ConditionCovariance(particles_[0].velocity.covariance);
  for (std::size_t i = 0; i < particles_.size(); ++i) {  // line 1
    Particle& particle = particles_[i];
    const PoseGaussian& predicted = predictions_[i];            // 2, (12)(13)
    const PoseProposal proposal = ProposePose(i, z);            // 3, (15)(16)
    const Pose s = proposal.pose.Sample(Key(Stream::pose, i));  // 4
    step_.ConditionMean(PathState(particle.pose), particle.velocity.mean, gain);
    const Eigen::Vector3d turn = PredictedTurn(step_, particle.pose, particle.velocity);
    // The bootstrap proposal is not a posterior: the answer is the weighted samples.
    const bool blind = params.proposal == Proposal::bootstrap;
    answer_.mixture.push_back(
        Component(blind ? PoseGaussian{s, Matrix6::Zero()} : proposal.pose, particle.pose, turn, gain));
    answer_.events += proposal.events;
    particle.velocity = VelocityGivenPose(gain, particle.pose, s, turn);  // 5-7, (37)-(43)
    // RB-PF samples the velocity as well, from its exact conditional: the weight stays.
    if (params.sampled == Sampled::pose_and_velocity)
      particle.velocity = {SampleNormal(particle.velocity.mean, particle.velocity.covariance, Key(Stream::velocity, i)),
                           Matrix6::Zero()};
    const double log_likelihood = UpdateLandmarks(i, s, z);  // 9, (3)
    UpdateProvisional(i, s);
    for (const Match& match : matches)
      particle.landmarks[match.landmark].covariance.topLeftCorner<2, 2>() += match.wander;
    particle.log_weight += params.weight == Weight::evidence  // 8
                               ? proposal.log_evidence
                               : predicted.LogDensity(s) + log_likelihood - proposal.pose.LogDensity(s);  // (17)
    particle.pose = s;
  }
  since_sampled_ = 0;
  Record(particles_.Normalise());
  answer_.effective_particles = particles_.EffectiveSize();
  FinishAnswer();
  if (answer_.effective_particles < params.resample_below * params.particles)  // 11
    Resample();
  return answer_;
}

PoseProposal Algorithm1::ProposePose(std::size_t particle, std::span<const Match> z) {
  const FilterParams& params = settings_.filter;
  const PoseGaussian& prediction = predictions_[particle];
  if (z.empty()) return {prediction, 0, {}};
  const LocalMap map = MapOf(particle);
  if (params.proposal == Proposal::ukf) return ProposeUnscented(prediction, map, z, Spread(params));
  matches_.batch.Load(map);
  if (params.proposal == Proposal::bootstrap) return {prediction, 0, {}};
  return Propose(prediction, matches_.batch, params, prediction.mean);
}

double Algorithm1::UpdateLandmarks(std::size_t particle, const Pose& sampled, std::span<const Match> z) {
  const FilterParams& params = settings_.filter;
  std::vector<Landmark>& landmarks = particles_[particle].landmarks;
  if (z.empty()) return 0;
  double log_likelihood = 0;
  if (params.proposal != Proposal::ukf) {
    if (params.proposal == Proposal::iterated) matches_.batch.Follow(Minus(sampled, matches_.batch.linearised_at()));
    log_likelihood =
        matches_.batch.UpdateLandmarks(sampled, params.proposal == Proposal::ekf ? 1 : params.max_iterations);
    matches_.batch.Store(landmarks);
    return log_likelihood;
  }
  for (const Match& match : z) {
    Landmark& landmark = landmarks[match.landmark];
    const AnchorView view = AnchorView(sampled, AnchorOf(particle, match.landmark)).ShiftedBy(match.centre_offset_W);
    const LandmarkUpdate update = UpdateLandmarkUnscented(landmark, view, match, Spread(params));
    landmark = update.landmark;
    log_likelihood += update.log_likelihood;
  }
  return log_likelihood;
}

void Algorithm1::UpdateProvisional(std::size_t particle, const Pose& sampled) {
  const FilterParams& params = settings_.filter;
  if (matches_.provisional.empty()) return;
  if (params.proposal == Proposal::ukf) {
    UpdateLandmarks(particle, sampled, matches_.provisional);
    return;
  }
  matches_.provisional_batch.Load(MapOf(particle));
  matches_.provisional_batch.UpdateLandmarks(sampled, params.proposal == Proposal::ekf ? 1 : params.max_iterations);
  matches_.provisional_batch.Store(particles_[particle].landmarks);
}

const FilterAnswer& Algorithm1::Coast() {
  answer_.mixture.clear();
  VelocityFilter::Gain gain = step_.ConditionCovariance(particles_[0].velocity.covariance);
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    const Particle& particle = particles_[i];
    step_.ConditionMean(PathState(particle.pose), particle.velocity.mean, gain);
    answer_.mixture.push_back(
        Component(predictions_[i], particle.pose, PredictedTurn(step_, particle.pose, particle.velocity), gain));
  }
  FinishAnswer();
  return answer_;
}

void Algorithm1::AddLandmarks(std::span<const FirstView> views) {
  if (views.empty()) return;
  if (since_sampled_ > 0) SampleStep({});
  const int anchor = AppendLandmarks(views);
  for (Particle& particle : particles_) particle.anchors[anchor] = particle.pose;
}

std::vector<ImagePrediction> Algorithm1::PredictImages(std::span<const int> landmarks) const {
  MatchBatch batch;
  batch.SetLandmarks(landmarks);
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    batch.Load(MapOf(i));
    batch.AddPredictions(predictions_[i].mean, predictions_[i].covariance, particles_.weights()[i]);
  }
  std::vector<ImagePrediction> predictions;
  for (std::size_t i = 0; i < landmarks.size(); ++i) predictions.push_back(batch.Moments(i).Prediction());
  return predictions;
}

ReferencePath Algorithm1::Reference() const {
  const std::size_t heaviest = particles_.Heaviest();
  ReferencePath reference{predictions_[heaviest], MapOf(heaviest), {}};
  const bool velocity_sampled = settings_.filter.sampled == Sampled::pose_and_velocity;
  if (velocity_sampled && settings_.motion.adaptive && correction_.motions.empty()) {
    const Belief& belief = answer_.belief;
    const VelocityFilter::State velocity{belief.velocity, belief.covariance.bottomRightCorner<6, 6>()};
    reference.prediction = PredictionOf(particles_[heaviest].pose, velocity, step_.PredictedCovariance(velocity));
  }
  return reference;
}

ParticlePhase::Modes Algorithm1::ModesOf(std::size_t particle) const {
  const std::vector<Landmark>& landmarks = particles_[particle].landmarks;
  static_assert(sizeof(Landmark) % sizeof(double) == 0);
  return {landmarks.empty() ? nullptr : landmarks[0].mean.data(), 3, table_.size(),
          Eigen::OuterStride<>(sizeof(Landmark) / sizeof(double))};
}

std::vector<Eigen::Matrix3d> Algorithm1::PointCovariances(int landmark) const {
  std::vector<Eigen::Matrix3d> covariances;
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    const Landmark& l = particles_[i].landmarks[landmark];
    const Eigen::Matrix3d J = PointJacobian(AnchorOf(i, landmark), l.mean);
    covariances.push_back(J * l.covariance * J.transpose());
  }
  return covariances;
}

}  // namespace vo
