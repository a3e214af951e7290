#include "vo/filter/initialisation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "vo/filter/algorithm1.h"
#include "vo/filter/first_guess.h"
#include "vo/filter/fixed_lag.h"

namespace vo {
namespace {

constexpr int kShutterRounds = 4;
constexpr double kObjectiveSettled = 0.1;  // change of -2 log p
// The next frame solves it all again.
constexpr double kStartToleranceSigma = 0.1;
constexpr double kGatePerMeasurement = 9.21 / 2;  // 99 % of chi-squared with two degrees of freedom

}  // namespace

void Initialisation::Predict(double dt, const MotionInput& input) {
  BeginFrame();
  ExtendPaths(dt, input);
  if (static_cast<int>(answered_.size()) == window_.size()) answered_.pop_back();  // its pose was integrated out
  SetReference();
}

void Initialisation::PredictAgain(const MotionInput& input) {
  ExtendPaths(0, input);
  SetReference();
}

const FilterAnswer& Initialisation::Update(std::span<const Match> z) {
  if (!z.empty()) {
    window_.SetMatches(z, table_);
    AddEvidence(-1);
    if (rolling())
      IterateShutterCorrection();
    else
      Solve(0, StartOptions());
    SolveAlternatives();
    ShareSolution();
    AddEvidence(1);
    answer_.events += particles_[0].solution.path.events;
  }
  Answer(!z.empty());
  answer_.scale_change = ScaleChange();
  answer_.start_score = kGatePerMeasurement * Measurements() - particles_[0].solution.path.objective;
  answered_ = particles_[0].solution.path.mean;
  if (window_.size() > settings_.filter.start_window) Finish();
  const int count = answer_.initialising ? 0 : window_.size() - settings_.filter.lag;
  if (rolling() && count > 0) CorrectRows({-1, count - 1}, true);
  SampleOldest(count);
  return answer_;
}

std::unique_ptr<ParticlePhase> Initialisation::Next() {
  if (answer_.initialising) return nullptr;
  if (settings_.filter.lag > 0) return std::make_unique<FixedLag>(std::move(*this));
  return std::make_unique<Algorithm1>(std::move(*this));
}

std::span<const double> Initialisation::SolutionWeights() const {
  static constexpr double kOne[] = {1.0};
  return kOne;
}

WindowOptions Initialisation::StartOptions() const {
  WindowOptions options = Options(true);
  options.tolerance_sigma = kStartToleranceSigma;
  return options;
}

CorrectedWindow Initialisation::Corrected(const PathSolution& solution, ShutterReference reference) const {
  return CorrectShutter(window_, table_, first_views_, InputOf(0), solution, {-1, window_.size() - 1}, reference, false,
                        settings_.landmark);
}

void Initialisation::Take(CorrectedWindow&& corrected) {
  window_ = std::move(corrected.window);
  particles_[0].landmarks = std::move(corrected.landmarks);
}

// Alternates between path and shutter corrections: with one iteration per frame residuals still reach fifteen standard
// deviations after thirty frames.
void Initialisation::IterateShutterCorrection() {
  double before = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kShutterRounds; ++round) {
    Take(Corrected(particles_[0].solution, ShutterReference::frame_pose));
    Solve(0, StartOptions());
    if (std::abs(particles_[0].solution.path.objective - before) < kObjectiveSettled) break;
    before = particles_[0].solution.path.objective;
  }
}

void Initialisation::SolveOther(std::size_t i, const WindowOptions& options, PathSolution& other) {
  if (!rolling()) return WindowPhase::SolveOther(i, options, other);
  const CorrectedWindow corrected = Corrected(other, ShutterReference::frame_pose);
  WindowInput in = InputOf(i);
  in.landmarks = corrected.landmarks;
  Solve(corrected.window, in, options, other);
}

// One other first guess in each frame; all where the present one does not fit: its objective is above the
// number of measurements.
void Initialisation::SolveAlternatives() {
  for (std::uint32_t k = 0; k < kGuesses; ++k) {
    SolveAlternative(0, frame_ + k, StartOptions());
    if (rolling()) Take(Corrected(particles_[0].solution, ShutterReference::frame_pose));
    if (particles_[0].solution.path.objective < Measurements()) break;
  }
}

// The first particle's solution becomes that of all, as seen from their start poses.
void Initialisation::ShareSolution() {
  for (std::size_t i = 1; i < particles_.size(); ++i) {
    particles_[i].solution = particles_[0].solution;
    vo::Move(particles_[i].pose * Inverse(particles_[0].pose), particles_[i].solution.path);
    particles_[i].landmarks = particles_[0].landmarks;
    window_.PlaceAnchors(particles_[i].solution.path, particles_[i].anchors);
  }
}

// Means over particles.
std::vector<StartPose> Initialisation::StartPath() const {
  const std::vector<double>& weights = particles_.weights();
  const auto mean = [&](const auto& pose_of) {
    std::vector<BeliefComponent> mixture;
    for (std::size_t i = 0; i < weights.size(); ++i)
      mixture.push_back({weights[i], pose_of(particles_[i]), Vector6::Zero(), Matrix12::Zero()});
    return Moments(mixture).pose;
  };
  std::vector<StartPose> start = {{0, mean([](const Particle& particle) { return particle.pose; })}};
  for (int k = 0; k < window_.size(); ++k)
    start.push_back(
        {window_.frames()[k].number, mean([k](const Particle& particle) { return particle.solution.path.mean[k]; })});
  return start;
}

// Gives each particle its own solution, to be sampled, and a weight.
void Initialisation::Finish() {
  const double log_evidence = particles_[0].solution.path.log_evidence;
  if (rolling()) {
    for (int round = 0; round < kShutterRounds; ++round) {
      Take(Corrected(particles_[0].solution, ShutterReference::row_pose));
      Solve(0, Options(false));
    }
    ShareSolution();
  }
  SolveAll();
  answer_.initialising = false;
  for (Particle& particle : particles_) {
    answer_.events += particle.solution.path.events;
    particle.log_weight += particle.solution.path.log_evidence - log_evidence;
  }
  Weigh();
  answer_.start = StartPath();
  // An unknown scale is a gauge freedom: with a separate draw for each particle their common map would have none.
  if (settings_.landmark.scale_sigma > 0)
    for (Particle& particle : particles_) ConditionOnScale(particle.pose, particle.solution.path);
}

// Factor of all lengths between the last answer's path and the present one, as far as scale explains the change. With
// d* and d the poses' places from the start, now and as answered: the factor of least squares d'd* / d'd, to the power
// of the share of the path's variance that lies along d, (d'Pd / d'd) / tr P. It is 1 where only the scale is uncertain
// and nearly 0 where every pose is: a wrong length must not set the scale of all to come.
double Initialisation::ScaleChange() const {
  const Pose& start = particles_[0].pose;
  const PathGaussian& path = particles_[0].solution.path;
  const auto count = static_cast<Eigen::Index>(answered_.size());
  Eigen::VectorXd was = Eigen::VectorXd::Zero(kPoseSize * count), is = was;
  double variance = 0;
  for (Eigen::Index k = 0; k < count; ++k) {
    was.segment<3>(kPoseSize * k) = answered_[static_cast<std::size_t>(k)].p_WC - start.p_WC;
    is.segment<3>(kPoseSize * k) = path.mean[static_cast<std::size_t>(k)].p_WC - start.p_WC;
    variance += path.covariance.block<3, 3>(kPoseSize * k, kPoseSize * k).trace();
  }
  const double square = was.squaredNorm(), product = was.dot(is);
  if (!(product > 0)) return 1;  // nothing answered yet, or another direction
  const auto P = path.covariance.topLeftCorner(kPoseSize * count, kPoseSize * count);
  const double share = was.dot(P * was) / (square * variance);
  if (!(share >= 0 && share <= 1)) return 1;  // counted as not_positive_definite
  return std::pow(product / square, share);
}

std::vector<Eigen::Matrix3d> Initialisation::PointCovariances(int landmark) const {
  const Eigen::Matrix3d first = PointCovariance(0, landmark);
  std::vector<Eigen::Matrix3d> covariances;
  for (const Particle& particle : particles_.particles()) {
    const Eigen::Matrix3d turn = (particle.pose.q_WC * particles_[0].pose.q_WC.conjugate()).toRotationMatrix();
    covariances.push_back(turn * first * turn.transpose());
  }
  return covariances;
}

}  // namespace vo
