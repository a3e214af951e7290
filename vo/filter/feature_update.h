// Feature update of one particle: the proposal of its pose from a frame's matches, and the update of its landmarks at
// the sampled pose.
// Source:  (15)(16) and (3) by the proposal that the settings name (docs/algorithm.md, sections 3, 3a and 8).
#pragma once

#include <span>

#include "vo/base/params.h"
#include "vo/filter/proposal.h"
#include "vo/filter/unscented.h"

namespace vo {

class FeatureUpdate {
 public:
  explicit FeatureUpdate(const FilterParams& params) : params_(params) {}

  // A frame's matches; they outlive the use of this object. Then each particle in turn: its proposal, then its
  // landmarks.
  void Begin(std::span<const Match> matches);
  // The prediction itself without matches, or for a proposal that is blind to the image.
  PoseProposal Propose(const PoseGaussian& prediction, const LocalMap& map);
  // Returns the sum of log p(z | pose) (3).
  double UpdateLandmarks(const Pose& sampled, const LocalMap& map, std::span<Landmark> landmarks);

 private:
  UnscentedParams unscented() const { return {params_.ukf_alpha, params_.ukf_beta, params_.ukf_kappa}; }

  FilterParams params_;
  std::span<const Match> matches_;
  MatchBatch batch_;
};

}  // namespace vo
