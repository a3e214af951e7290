// Phase of the particle filter: when poses are sampled. Initialisation and fixed lag keep them Gaussian for a while,
// Algorithm 1 samples at once. A phase owns the particles and the landmark table, and hands both to its successor.
#pragma once

#include <cstdint>
#include <memory>

#include "vo/base/params.h"
#include "vo/base/random.h"
#include "vo/filter/filter.h"
#include "vo/filter/landmark_table.h"
#include "vo/filter/particle_set.h"

namespace vo {

struct ParticleFilterSettings {
  MotionParams motion;
  FilterParams filter;
  LandmarkParams landmark;
  std::uint64_t seed = 0;
};

class ParticlePhase : public Filter {
 public:
  // The phase that follows, once this one is over; it takes the state.
  virtual std::unique_ptr<ParticlePhase> Next() { return nullptr; }

  void KeepLandmarks(const std::vector<bool>& keep) override { CompactLandmarks(keep); }
  std::vector<LandmarkBelief> LandmarkBeliefs() const override;
  std::vector<LandmarkSpread> LandmarkSpreads() const override;
  int landmark_count() const override { return table_.size(); }
  const FilterAnswer& answer() const override { return answer_; }
  const ParticleSet& particles() const { return particles_; }

 protected:
  ParticlePhase(const ParticleFilterSettings& settings, const FilterPrior& prior);

  // (x, y, rho) of the landmarks by all images of the particle's path, one for each column.
  using Modes = Eigen::Map<const Eigen::Matrix3Xd, 0, Eigen::OuterStride<>>;
  virtual Modes ModesOf(std::size_t particle) const = 0;
  // Covariance of a landmark's place in W, for each particle with a weight.
  virtual std::vector<Eigen::Matrix3d> PointCovariances(int landmark) const = 0;

  void BeginFrame();
  std::vector<int> CompactLandmarks(const std::vector<bool>& keep);  // returns the new index of each, -1: dropped
  RandomKey Key(Stream stream, std::size_t particle) const {
    return {settings_.seed, stream, frame_, static_cast<std::uint32_t>(particle)};
  }
  LocalMap MapOf(std::size_t particle) const {
    return {particles_[particle].landmarks, table_.anchors(), particles_[particle].anchors};
  }
  const Pose& AnchorOf(std::size_t particle, int landmark) const {
    return particles_[particle].anchors[table_.anchor_of(landmark)];
  }
  // New landmarks of all particles. Returns the anchor's index; its pose is left to the caller.
  int AppendLandmarks(std::span<const FirstView> views);
  // Motion of each particle's path in W, T_WC -> M T_WC: last sampled pose, velocity and landmarks (PathCorrection).
  struct Correction {
    std::vector<Pose> motions;
    int first_landmark = 0;
  };
  void Move(const Correction& correction);
  std::vector<bool> MovingAnchors(int first_landmark) const;
  void Resample() { particles_.Resample(Uniform(Key(Stream::resampling, 0), 0)); }
  // Counts replaced particles, and copies their components of the mixture.
  void Record(const ParticleSet::Replacement& replaced);
  // The belief from the mixture and the weights.
  void FinishAnswer();

  ParticleFilterSettings settings_;
  ParticleSet particles_;
  LandmarkTable table_;
  FilterAnswer answer_;
  std::uint32_t frame_ = 0;
};

}  // namespace vo
