// Phases with un-sampled poses: each particle's path is Gaussian over a window of frames, extended by prediction,
// solved with every image, and sampled at its oldest end.
// Source:  docs/algorithm.md, section 9.
#pragma once

#include <optional>
#include <vector>

#include "vo/filter/particle_phase.h"
#include "vo/filter/shutter_correction.h"
#include "vo/filter/window.h"

namespace vo {

class WindowPhase : public ParticlePhase {
 public:
  void AddLandmarks(std::span<const FirstView> views) override;
  void KeepLandmarks(const std::vector<bool>& keep) override;
  std::vector<ImagePrediction> PredictImages(std::span<const int> landmarks) const override;
  ReferencePath Reference() const override;  // of the heaviest particle
  std::vector<LandmarkSpread> LandmarkSpreads() const override;

 protected:
  WindowPhase(const ParticleFilterSettings& settings, const FilterPrior& prior);

  // Weights of the first particles, those with a solution of their own.
  virtual std::span<const double> SolutionWeights() const = 0;
  Modes ModesOf(std::size_t particle) const override {
    const std::vector<Eigen::Vector3d>& modes = particles_[particle].solution.modes;
    return {modes.empty() ? nullptr : modes[0].data(), 3, table_.size(), Eigen::OuterStride<>(3)};
  }
  std::vector<Eigen::Matrix3d> PointCovariances(int landmark) const override;
  Eigen::Matrix3d PointCovariance(std::size_t particle, int landmark) const;
  WindowInput InputOf(std::size_t i) const {
    return {particles_[i].pose, particles_[i].velocity.mean, particles_[i].landmarks, particles_[i].anchors,
            first_views_};
  }

  LandmarkOnPath OnPath(std::size_t i, const Track& track) const {
    return {InputOf(i), track, particles_[i].solution.path, particles_[i].solution.modes[track.landmark]};
  }

  // One more pose, dt [s] after the last, which is integrated out if nothing refers to it. dt = 0: in its place.
  void ExtendPaths(double dt, const MotionInput& input);
  void SetPrior();  // of the window's steps
  // The landmarks of the heaviest particle given its path.
  void SetReference();
  // Options of a solution; `initialising`: from a first guess that may be far off.
  WindowOptions Options(bool initialising) const;
  void Solve(const Window& window, const WindowInput& in, const WindowOptions& options, PathSolution& solution);
  void Solve(std::size_t particle, const WindowOptions& options);
  // All particles, from first guesses near their modes: the heaviest, and the others by its linearisation.
  void SolveAll();
  // Replaces the solution by another mode where that is better: from first guess number `guess`, taken in turn.
  void SolveAlternative(std::size_t particle, std::uint32_t guess, WindowOptions options);
  virtual void SolveOther(std::size_t particle, const WindowOptions& options, PathSolution& other) {
    Solve(window_, InputOf(particle), options, other);
  }
  // Whether the first views are rows of a rolling shutter.
  bool rolling() const;
  // Image coordinates in the window.
  int Measurements() const;
  // To the log weights; -1 removes that of the last solution.
  void AddEvidence(double sign);
  // Mixture and belief; the weights first, if the window has new matches.
  void Answer(bool updated);
  void Weigh();
  // Rows of these slots referred to their stamps anew, from what they measured, by the heaviest particle's path.
  void CorrectRows(SlotRange slots, bool rates);
  void SampleOldest(int count);

  Window window_;
  std::vector<FirstView> first_views_;  // per landmark
  std::optional<PathPrior> prior_;      // of the window's steps; all particles share it
  PathWindow solver_;
  struct ReferenceLandmarks {  // of the heaviest particle, given its path
    std::vector<LandmarkOnPath::Conditional> given_path;
    std::vector<Landmark> landmarks;  // the same, with the modes
  };
  ReferenceLandmarks reference_;
  // Particles with the linearisation of the heaviest, in the last solution of all; empty: the window has changed since.
  std::vector<bool> alike_;

 private:
  bool IsAlike(std::size_t particle) const { return !alike_.empty() && alike_[particle]; }
  void Follow(const std::vector<Pose>& solved, PathSolution& solution);
  void Commit(int count);
};

}  // namespace vo
