#include "vo/filter/feature_update.h"

#include "vo/filter/unscented_proposal.h"

namespace vo {

void FeatureUpdate::Begin(std::span<const Match> matches) {
  matches_ = matches;
  batch_.SetMatches(matches);
}

PoseProposal FeatureUpdate::Propose(const PoseGaussian& prediction, const LocalMap& map) {
  if (matches_.empty()) return {prediction, 0, {}};
  if (params_.proposal == Proposal::ukf) return ProposeUnscented(prediction, map, matches_, unscented());
  batch_.Load(map);
  if (params_.proposal == Proposal::bootstrap) return {prediction, 0, {}};
  return vo::Propose(prediction, batch_, params_);
}

double FeatureUpdate::UpdateLandmarks(const Pose& sampled, const LocalMap& map, std::span<Landmark> landmarks) {
  if (matches_.empty()) return 0;
  if (params_.proposal != Proposal::ukf) {
    if (params_.proposal == Proposal::iterated) batch_.Follow(Minus(sampled, batch_.linearised_at()));
    const double log_likelihood =
        batch_.UpdateLandmarks(sampled, params_.proposal == Proposal::ekf ? 1 : params_.max_iterations);
    batch_.Store(landmarks);
    return log_likelihood;
  }
  double log_likelihood = 0;
  for (const Match& match : matches_) {
    Landmark& landmark = landmarks[match.landmark];
    const AnchorView view(sampled, map.anchors[map.anchor_of[match.landmark]]);
    const LandmarkUpdate update =
        UpdateLandmarkUnscented(landmark, view.ShiftedBy(match.centre_offset_W), match, unscented());
    landmark = update.landmark;
    log_likelihood += update.log_likelihood;
  }
  return log_likelihood;
}

}  // namespace vo
