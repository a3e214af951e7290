// Initialisation: the first frames are one window, solved again with every image, before any pose is sampled.
// All particles share one solution, as seen from their start poses, until the window is full; each is
// compared with solutions from other first guesses (multi-start).
// Source:  docs/algorithm.md, section 9.
#pragma once

#include "vo/filter/window_phase.h"

namespace vo {

class Initialisation final : public WindowPhase {
 public:
  Initialisation(const ParticleFilterSettings& settings, const FilterPrior& prior) : WindowPhase(settings, prior) {}

  void Predict(double dt, const MotionInput& input = {}) override;
  void PredictAgain(const MotionInput& input) override;
  const FilterAnswer& Update(std::span<const Match> z) override;
  // FixedLag or, for lag 0, Algorithm1, once the first poses are sampled.
  std::unique_ptr<ParticlePhase> Next() override;

 protected:
  std::span<const double> SolutionWeights() const override;
  std::vector<Eigen::Matrix3d> PointCovariances(int landmark) const override;
  // With a rolling shutter, of the rows as the other mode corrects them.
  void SolveOther(std::size_t i, const WindowOptions& options, PathSolution& other) override;

 private:
  WindowOptions StartOptions() const;
  CorrectedWindow Corrected(const PathSolution& solution, ShutterReference reference) const;
  void Take(CorrectedWindow&& corrected);
  void IterateShutterCorrection();
  void SolveAlternatives();
  void ShareSolution();
  std::vector<StartPose> StartPath() const;
  void Finish();
  double ScaleChange() const;

  std::vector<Pose> answered_;  // the path at the last answer
};

}  // namespace vo
