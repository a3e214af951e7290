// Algorithm 1: every pose is sampled in its own frame. RB2-PF and, with the velocity sampled as well, RB-PF and
// FastSLAM.
// Source:  Zhou & Maskell, Algorithm 1; docs/algorithm.md, section 3.
#pragma once

#include <vector>

#include "vo/filter/particle_phase.h"
#include "vo/filter/proposal.h"
#include "vo/filter/velocity_filter.h"

namespace vo {

class Algorithm1 final : public ParticlePhase {
 public:
  Algorithm1(const ParticleFilterSettings& settings, const FilterPrior& prior);
  // Continues with the particles of a finished phase, all of whose poses are sampled.
  explicit Algorithm1(ParticlePhase&& finished);

  void Predict(double dt, const MotionInput& input = {}) override;
  void PredictAgain(const MotionInput& input) override;
  // Without matches nothing is sampled: the next Predict spans the time since the last sampled pose, which is exact.
  const FilterAnswer& Update(std::span<const Match> z) override;
  // At the present pose, which is sampled now if the filter coasts.
  void AddLandmarks(std::span<const FirstView> views) override;
  std::vector<ImagePrediction> PredictImages(std::span<const int> landmarks) const override;
  // Of the heaviest particle. A sampled velocity has no covariance, which innovations are measured by: with
  // motion.adaptive the mixture's takes its place, but for a corrected path.
  ReferencePath Reference() const override;
  const std::vector<PoseGaussian>& predictions() const { return predictions_; }  // (12)(13), of each particle

 protected:
  Modes ModesOf(std::size_t particle) const override;
  std::vector<Eigen::Matrix3d> PointCovariances(int landmark) const override;

 private:
  PoseGaussian PredictionOf(const Pose& pose, const VelocityFilter::State& velocity, const Matrix6& covariance) const;
  void PredictParticles();
  const FilterAnswer& Coast();
  const FilterAnswer& SampleStep(std::span<const Match> matches);
  // (15)(16) by the proposal of the settings (docs/algorithm.md, sections 3, 3a and 8). The prediction itself without
  // matches, or for the bootstrap proposal, which does not use the image.
  PoseProposal ProposePose(std::size_t particle, std::span<const Match> z);
  // Of the same particle, at its sampled pose. Returns the sum of log p(z | pose) (3).
  double UpdateLandmarks(std::size_t particle, const Pose& sampled, std::span<const Match> z);
  // The same for provisional matches, which the proposal does not use.
  void UpdateProvisional(std::size_t particle, const Pose& sampled);

  struct FrameMatches {
    std::vector<Match> acting, provisional;
    MatchBatch batch, provisional_batch;  // these, and one particle in turn
  };

  double since_sampled_ = 0;                // [s]; 0 when the present pose is sampled
  VelocityFilter step_;                     // from the last sampled pose to the present
  std::optional<Eigen::Quaterniond> turn_;  // measured, in place of the model's
  std::vector<PoseGaussian> predictions_;
  Correction correction_;  // of this frame's prediction
  FrameMatches matches_;
};

}  // namespace vo
