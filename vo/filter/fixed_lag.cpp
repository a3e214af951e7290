#include "vo/filter/fixed_lag.h"

namespace vo {

void FixedLag::Predict(double dt, const MotionInput& input) {
  BeginFrame();
  ExtendPaths(dt, input);
  extended_.resize(particles_.size());
  for (std::size_t i = 0; i < particles_.size(); ++i) extended_[i] = particles_[i].solution;
  SolveAgain();
}

void FixedLag::PredictAgain(const MotionInput& input) {
  for (std::size_t i = 0; i < particles_.size(); ++i) particles_[i].solution = extended_[i];
  ExtendPaths(0, input);
  SolveAgain();
}

void FixedLag::SolveAgain() {
  if (!answer_.initialising)  // the poses sampled since have changed the rest
    for (std::size_t i = 0; i < particles_.size(); ++i) Solve(i, Options(false));
  SetReferenceLandmarks();
}

const FilterAnswer& FixedLag::Update(std::span<const Match> z) {
  if (!z.empty()) {
    window_.SetMatches(z, table_);
    AddEvidence(-1);
    for (std::size_t i = 0; i < particles_.size(); ++i) Solve(i, Options(answer_.initialising));
    if (answer_.initialising)
      for (std::size_t i = 0; i < particles_.size(); ++i)
        Challenge(i, static_cast<std::uint32_t>(i) + frame_, Options(true));
    AddEvidence(1);
    for (const Particle& particle : particles_) answer_.events += particle.solution.path.events;
  }
  Answer(!z.empty());
  const int count = window_.size() - settings_.filter.lag;
  if (count > 0) answer_.initialising = false;
  SampleOldest(count);
  return answer_;
}

}  // namespace vo
