// Purpose: the optimal proposal (15)(16): the prediction of one particle, updated with all matched features at once.
// Source:  FastSLAM 2.0; the iterated form is a Gauss-Newton over pose and landmarks together, each landmark eliminated by its own
//          Schur complement (algorithm, section 8): cost linear in the number of matches.
#pragma once

#include <span>
#include <vector>

#include "vo/filter/pose_gaussian.h"
#include "vo/map/landmark.h"
#include "vo/map/linearised_match.h"
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

// Rows of a match's Jacobian by the pose's (dp in W, dphi in C).
struct PoseRows {
  void Set(const LinearisedMatch& h, const AnchorView& view, double rho);
  Vector6 j0, j1;
};

class PoseProposer {
 public:
  // Proposal::ekf: one linearisation at the prediction. Proposal::iterated: until within 1e-3 standard deviations of the mode or
  // max_iterations. Landmarks that come to lie behind the camera are left out of that iteration. No matches: the prediction itself.
  PoseProposal Propose(const PoseGaussian& prediction, const LocalMap& map, std::span<const Match> matches, const FilterParams& params);

  // After Propose: where the landmark of a match (by its place among the matches) would be best if the pose were last_linearised()
  // (+) d, to first order. `mean`: its prior's.
  Eigen::Vector3d ModeGiven(std::size_t match, const Vector6& d, const Eigen::Vector3d& mean) const;
  const Pose& last_linearised() const { return linearised_at_; }

 private:
  // Workspace, so that repeated calls allocate nothing.
  std::vector<Eigen::Vector3d> theta_;
  std::vector<LinearisedMatch> matches_;
  std::vector<PoseRows> rows_;
  std::vector<AnchorView> views_;
  Pose linearised_at_;
};

// The same for one call.
PoseProposal Propose(const PoseGaussian& prediction, const LocalMap& map, std::span<const Match> matches, const FilterParams& params);

}  // namespace vo
