// Optimal proposal (15)(16): the prediction of one particle, updated with all matched features at once.
// Source:  FastSLAM 2.0; the iterated form is a Gauss-Newton over pose and landmarks together, each landmark eliminated
//          by its own Schur complement (docs/algorithm.md, section 8): cost linear in the number of matches.
#pragma once

#include "vo/base/params.h"
#include "vo/base/result.h"
#include "vo/filter/pose_gaussian.h"
#include "vo/map/match_batch.h"

namespace vo {

struct PoseProposal {
  PoseGaussian pose;
  // log p(z_t | path of the particle): exact when linear and Gaussian, else Laplace's approximation
  double log_evidence = 0;
  NumericalEvents events;  // not positive definite: the evidence is not a number
};

// `batch`: the matches, at least one, and the particle's landmarks, as loaded; at the end batch.linearised_at() is the
// point of linearisation. Proposal::ekf: one linearisation at the prediction. Proposal::iterated: until within
// kToleranceSigma (gauss_newton.h) of the mode or max_iterations. Landmarks that come to lie behind the camera are left
// out of that iteration. `start`: initial value of the iteration, with the landmarks where the batch has them.
PoseProposal Propose(const PoseGaussian& prediction, MatchBatch& batch, const FilterParams& params, const Pose& start);

}  // namespace vo
