#include "vo/filter/fixed_lag.h"

#include <tuple>
#include <utility>

namespace vo {

void FixedLag::Predict(double dt, const MotionInput& input) {
  BeginFrame();
  uncorrected_.reset();
  ExtendPaths(dt, input);
  SetReference();
}

void FixedLag::PredictAgain(const MotionInput& input) {
  if (uncorrected_) {
    std::tie(window_, particles_) = std::move(*uncorrected_);
    uncorrected_.reset();
    prior_.reset();
  }
  ExtendPaths(0, input);
  if (input.correction) Correct(*input.correction);
  SetReference();
}

// The window moves as a whole. Its observations of landmarks that stay in place are dropped.
void FixedLag::Correct(const PathCorrection& correction) {
  uncorrected_.emplace(window_, particles_);
  Correction motion{{}, correction.first_landmark};
  for (const Particle& particle : particles_.particles())
    motion.motions.push_back(correction.pose * Inverse(particle.solution.path.mean.back()));
  Move(motion);
  for (std::size_t i = 0; i < particles_.size(); ++i) vo::Move(motion.motions[i], particles_[i].solution.path);
  window_.KeepMatchesOf(MovingAnchors(correction.first_landmark), table_);
  SetPrior();
  SolveAll();
}

const FilterAnswer& FixedLag::Update(std::span<const Match> z) {
  if (!z.empty()) {
    if (!answer_.initialising && rolling()) CorrectRows({0, window_.size() - 3}, false);
    window_.SetMatches(z, table_);
    AddEvidence(-1);
    if (!answer_.initialising) {
      SolveAll();
    } else {
      for (std::size_t i = 0; i < particles_.size(); ++i) Solve(i, Options(true));
      for (std::size_t i = 0; i < particles_.size(); ++i)
        SolveAlternative(i, static_cast<std::uint32_t>(i) + frame_, Options(true));
    }
    AddEvidence(1);
    for (const Particle& particle : particles_) answer_.events += particle.solution.path.events;
  }
  Answer(!z.empty());
  const int count = window_.size() - settings_.filter.lag;
  if (rolling() && count > 0) CorrectRows({answer_.initialising ? -1 : 0, count - 1}, true);
  if (count > 0) answer_.initialising = false;
  SampleOldest(count);
  if (!answer_.initialising && window_.size() > 0) SolveRest();
  return answer_;
}

// The rest is solved again after poses were sampled. Landmarks of shared linearisations have been updated, evidence has
// not.
void FixedLag::SolveRest() {
  SetPrior();
  if (alike_.empty()) return SolveAll();
  for (std::size_t i = 0; i < alike_.size(); ++i)
    if (!alike_[i]) Solve(i, Options(false));
}

}  // namespace vo
