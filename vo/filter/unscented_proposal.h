// Unscented proposal (15)(16), the paper's own: an unscented update of the predicted pose with all matched features at
// once, and the unscented update of a landmark at a known pose.
// Source:  docs/algorithm.md, section 3a; with pose and velocity sampled this is Unscented FastSLAM 2.0, the paper's
//          baseline.
#pragma once

#include <span>

#include "vo/filter/proposal.h"
#include "vo/filter/unscented.h"
#include "vo/map/landmark.h"

namespace vo {

// Sigma points of the pose, q_hat (x) Exp(chi). Given the pose the features are independent of one another, so each is
// linearised statistically by itself, z_n = z_bar_n + C_n (s - s_hat) + noise, and all are taken in information form:
// cost linear in the matches. The noise of a feature is what the straight line leaves, its landmark's share, and R.
// Landmarks that lie behind the camera at a sigma point are left out.
PoseProposal ProposeUnscented(const PoseGaussian& prediction, const LocalMap& map, std::span<const Match> matches,
                              const UnscentedParams& params);

// Its log_likelihood is log N(z; z_hat, S), with the mean and covariance (3) of the sigma points.
LandmarkUpdate UpdateLandmarkUnscented(const Landmark& prior, const AnchorView& view, const Match& match,
                                       const UnscentedParams& params);

}  // namespace vo
