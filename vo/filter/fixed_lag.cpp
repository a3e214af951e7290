#include "vo/filter/fixed_lag.h"

#include <cmath>
#include <utility>

#include "vo/filter/mode_challenge.h"

namespace vo {

void FixedLag::Predict(double dt) {
  ExtendPaths(dt);
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
      for (std::size_t i = 0; i < particles_.size(); ++i) Challenge(i);
    AddEvidence(1);
    for (const PathSolution& solution : solutions_) answer_.events += solution.path.events;
  }
  Answer(!z.empty());
  const int count = window_.size() - settings_.filter.lag;
  if (count > 0) answer_.initialising = false;
  SampleOldest(count);
  return answer_;
}

void FixedLag::Challenge(std::size_t i) {
  PathSolution other = PerturbTranslation(window_, table_, InputOf(i), solutions_[i],
                                          (static_cast<std::uint32_t>(i) + frame_) % kGuesses);
  WindowOptions options = Options(true);
  options.stop_if_above = solutions_[i].path.objective;
  Solve(window_, InputOf(i), options, other);
  if (IsBetter(other.path, solutions_[i].path)) solutions_[i] = std::move(other);
  window_.PlaceAnchors(solutions_[i].path, particles_[i].anchors);
}

}  // namespace vo
