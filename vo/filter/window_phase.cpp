#include "vo/filter/window_phase.h"

#include <algorithm>
#include <cmath>

#include "vo/filter/first_guess.h"
#include "vo/filter/path_sampling.h"

namespace vo {
namespace {

// Uniform weights: log Bayes factor of the window's images against the best particle beyond which a particle is
// rejected. Under a correct model the worst of 8 or 64 particles stays within 33 nats of the best; a particle in a
// wrong mode is hundreds away.
constexpr double kLogBayesRejection = 50;

constexpr int kStartIterations = 50;
constexpr int kDescents = 5;

}  // namespace

WindowPhase::WindowPhase(const ParticleFilterSettings& settings, const FilterPrior& prior)
    : ParticlePhase(settings, prior) {
  answer_.initialising = true;
}

void WindowPhase::ExtendPaths(double dt, const MotionInput& input) {
  alike_.clear();
  if (window_.LastIsUnused()) {
    prior_.reset();
    dt += window_.DropLast(table_);
    for (Particle& particle : particles_) DropLast(particle.solution.path);
  }
  if (!prior_) SetPrior();
  const MotionModel step = NearlyConstantVelocity(settings_.motion, dt, input);
  for (Particle& particle : particles_)
    Extend(*prior_, step, particle.pose, particle.velocity.mean, input.turn, particle.solution.path);
  window_.Append(dt, frame_, input, table_);
  SetPrior();
}

void WindowPhase::SetPrior() {
  std::vector<MotionModel> models, of_rates;
  const bool with_rates = rolling();
  for (const Window::Frame& frame : window_.frames()) {
    models.push_back(NearlyConstantVelocity(settings_.motion, frame.dt, frame.input));
    if (with_rates)
      of_rates.push_back(answer_.initialising ? NearlyConstantVelocity(settings_.motion, frame.dt) : models.back());
  }
  prior_.emplace(models, particles_[0].velocity.covariance, of_rates);
}

WindowOptions WindowPhase::Options(bool initialising) const {
  const FilterParams& params = settings_.filter;
  const int iterations = initialising ? std::max(params.max_iterations, kStartIterations) : params.max_iterations;
  WindowOptions options{params.proposal == Proposal::ekf ? 1 : iterations, params.marginal_mode};
  if (prior_->rate_precision().size() > 0) options.rates = answer_.initialising ? Rates::with_start : Rates::of_window;
  return options;
}

void WindowPhase::Solve(const Window& window, const WindowInput& in, const WindowOptions& options,
                        PathSolution& solution) {
  std::vector<Eigen::Vector3d> theta = ModesOfTracks(window.tracks(), solution);
  solver_.Solve(*prior_, in, window.tracks(), options, solution.path, theta);
  SetModes(window.tracks(), theta, solution);
}

void WindowPhase::Solve(std::size_t particle, const WindowOptions& options) {
  Solve(window_, InputOf(particle), options, particles_[particle].solution);
  window_.PlaceAnchors(particles_[particle].solution.path, particles_[particle].anchors);
}

void WindowPhase::SolveAlternative(std::size_t i, std::uint32_t guess, WindowOptions options) {
  const PathSolution& present = particles_[i].solution;
  std::optional<PathSolution> first = FirstGuess(window_, table_, InputOf(i), present, guess % kGuesses);
  if (!first) return;
  PathSolution& other = *first;
  const double objective = present.path.objective;
  options.stop_if_above = objective;
  for (int descent = 0; descent < kDescents; ++descent) {  // one that has not ended below the present solution goes on
    SolveOther(i, options, other);
    if (other.path.events.not_converged == 0 || !(other.path.objective < objective)) break;
  }
  // By the density at the mode, not by evidence: evidence favours depths that stay unknown, as if each had a prior of
  // its own, and prefers a deep scene with little parallax to a wall. Where the descent has not converged, the
  // objective is that of an expansion far from the mode; matches behind the camera are not part of it.
  const NumericalEvents &had = particles_[i].solution.path.events, &has = other.path.events;
  if (std::isnan(objective) ||
      (other.path.objective < objective && has.not_converged == 0 && has.behind_camera <= had.behind_camera))
    particles_[i].solution = std::move(other);
  window_.PlaceAnchors(particles_[i].solution.path, particles_[i].anchors);
}

int WindowPhase::Measurements() const {
  int views = 0;
  for (const Track& track : window_.tracks()) views += static_cast<int>(track.views.size());
  return 2 * views;
}

void WindowPhase::AddEvidence(double sign) {
  for (std::size_t i = 0; i < particles_.size(); ++i)
    particles_[i].log_weight += sign * particles_[i].solution.path.log_evidence;
}

void WindowPhase::Answer(bool updated) {
  answer_.mixture.clear();
  for (std::size_t i = 0; i < particles_.size(); ++i)
    answer_.mixture.push_back(
        ComponentAtTheEnd(*prior_, particles_[i].pose, particles_[i].velocity.mean, particles_[i].solution.path));
  if (updated) Weigh();
  FinishAnswer();
}

void WindowPhase::Weigh() {
  std::vector<double> log_evidence;
  for (const Particle& particle : particles_) log_evidence.push_back(particle.solution.path.log_evidence);
  Record(settings_.filter.weight == Weight::uniform ? particles_.NormaliseUniform(log_evidence, kLogBayesRejection)
                                                    : particles_.Normalise());
  answer_.effective_particles = particles_.EffectiveSize();
}

void WindowPhase::SampleOldest(int count) {
  const FilterParams& params = settings_.filter;
  const bool uniform = params.weight == Weight::uniform;
  // Uniform weights: rejected particles are replaced before the draw, so that the copies differ by it.
  if (uniform && count > 0 && particles_.AnyRejected()) {
    Resample();
    alike_.clear();
  }
  if (count > 0) Commit(count);
  if (!uniform && answer_.effective_particles < params.resample_below * params.particles) Resample();
}

// Samples the oldest poses, conditions the rest on them, and updates velocity and landmarks with those frames.
void WindowPhase::Commit(int count) {
  for (int k = 0; k < count; ++k) {
    const std::vector<Pose> drawn =
        SamplePoses(particles_, k, settings_.filter.weight == Weight::uniform, [&](std::size_t i) {
          return RandomKey{settings_.seed, Stream::pose, window_.frames()[k].number, static_cast<std::uint32_t>(i)};
        });
    for (std::size_t i = 0; i < particles_.size(); ++i) {
      const std::vector<Pose> solved = particles_[i].solution.path.mean;
      ConditionOn(k, drawn[i], particles_[i].solution.path);
      if (IsAlike(i)) Follow(solved, particles_[i].solution);
    }
  }
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    window_.PlaceAnchors(particles_[i].solution.path, particles_[i].anchors);
    if (count > 1)  // the draws of many poses move the landmarks far
      particles_[i].solution.modes = Triangulate(window_, table_, InputOf(i), particles_[i].solution);
  }
  for (int k = 0; k < count; ++k) {
    const VelocityFilter step(settings_.motion, window_.frames()[k].dt, window_.frames()[k].input);
    std::vector<LandmarkGain> of_all;
    for (std::size_t i = 0; i < particles_.size(); ++i) {
      std::vector<LandmarkGain> own;
      UpdateGivenPose(step, window_, table_, k, IsAlike(i) ? of_all : own, particles_[i]);
    }
  }
  for (Particle& particle : particles_) {
    PathGaussian& path = particle.solution.path;
    path.mean.erase(path.mean.begin(), path.mean.begin() + count);
    path.turns.erase(path.turns.begin(), path.turns.begin() + count);
    path.rates.erase(path.rates.begin(), path.rates.begin() + count);
  }
  window_.DropOldest(count, table_);
  prior_.reset();
}

}  // namespace vo
