// Particle filter RB2-PF, and RB-PF and FastSLAM by its settings: particles over the camera's path, each with a Kalman
// filter for the velocity and one for every landmark.
// Source:  Zhou & Maskell, Algorithm 1; docs/algorithm.md.
// Phases:  start_window > lag: Initialisation, then FixedLag or, for lag 0, Algorithm1. Otherwise FixedLag or
//          Algorithm1 from the first frame on.
#pragma once

#include <memory>

#include "vo/filter/particle_phase.h"

namespace vo {

class ParticleFilter final : public Filter {
 public:
  ParticleFilter(const MotionParams& motion, const FilterParams& filter, const LandmarkParams& landmark,
                 const FilterPrior& prior, std::uint64_t seed);

  void Predict(double dt, const MotionInput& input = {}) override { phase_->Predict(dt, input); }
  void PredictAgain(const MotionInput& input) override { phase_->PredictAgain(input); }
  const FilterAnswer& Update(std::span<const Match> matches) override;
  void AddLandmarks(std::span<const FirstView> views) override { phase_->AddLandmarks(views); }
  void KeepLandmarks(const std::vector<bool>& keep) override { phase_->KeepLandmarks(keep); }
  int landmark_count() const override { return phase_->landmark_count(); }
  const FilterAnswer& answer() const override { return phase_->answer(); }
  std::vector<ImagePrediction> PredictImages(std::span<const int> landmarks) const override {
    return phase_->PredictImages(landmarks);
  }
  ReferencePath Reference() const override { return phase_->Reference(); }
  std::vector<LandmarkBelief> LandmarkBeliefs() const override { return phase_->LandmarkBeliefs(); }
  std::vector<LandmarkSpread> LandmarkSpreads() const override { return phase_->LandmarkSpreads(); }

  const ParticlePhase& phase() const { return *phase_; }
  const std::vector<Particle>& particles() const { return phase_->particles().particles(); }
  const std::vector<double>& weights() const { return phase_->particles().weights(); }

 private:
  std::unique_ptr<ParticlePhase> phase_;
};

}  // namespace vo
