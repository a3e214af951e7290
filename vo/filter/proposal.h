// Purpose: the optimal proposal (15)(16): the prediction of one particle, updated with all matched features at once.
// Source:  FastSLAM 2.0; the iterated form is a Gauss-Newton over pose and landmarks together, each landmark eliminated by its own
//          Schur complement (algorithm, section 8): cost linear in the number of matches.
#pragma once

#include <span>

#include "vo/filter/pose_gaussian.h"
#include "vo/map/landmark.h"
#include "vo/params.h"

namespace vo {

// What a proposal needs to see of one particle.
struct LocalMap {
  std::span<const Landmark> landmarks;
  std::span<const int> anchor_of;   // per landmark: index into anchors
  std::span<const Pose> anchors;
};

struct PoseProposal {
  PoseGaussian pose;
  double log_evidence = 0;  // log p(z_t | path of the particle): exact when linear and Gaussian, else Laplace's approximation
};

// Proposal::ekf: one linearisation at the prediction. Proposal::iterated: until the step is below 1e-5 standard deviations or max_iterations.
// Landmarks that come to lie behind the camera are left out of that iteration. No matches: the prediction itself.
PoseProposal Propose(const PoseGaussian& prediction, const LocalMap& map, std::span<const Match> matches,
                     const FilterParams& params);

}  // namespace vo
