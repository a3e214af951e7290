// Fixed lag: a pose is sampled once the images of the `lag` frames after it are in. Until the first one is sampled,
// every solution is compared with one from another first guess (multi-start).
// Source:  docs/algorithm.md, section 9.
#pragma once

#include "vo/filter/window_phase.h"

namespace vo {

class FixedLag final : public WindowPhase {
 public:
  FixedLag(const ParticleFilterSettings& settings, const FilterPrior& prior) : WindowPhase(settings, prior) {}
  // Continues with the window and the solutions of a finished initialisation.
  explicit FixedLag(WindowPhase&& finished) : WindowPhase(std::move(finished)) { SolveRest(); }

  void Predict(double dt, const MotionInput& input = {}) override;
  void PredictAgain(const MotionInput& input) override;
  const FilterAnswer& Update(std::span<const Match> z) override;

 protected:
  std::span<const double> SolutionWeights() const override { return particles_.weights(); }

 private:
  void Correct(const PathCorrection& correction);
  void SolveRest();

  std::optional<std::pair<Window, ParticleSet>> uncorrected_;  // to undo a correction until the update
};

}  // namespace vo
