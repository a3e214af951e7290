// End of an un-sampled path: the velocity there, and the pose one step later.
// Source:  the velocity is linear in the steps u of path_prior.h, and these in the poses; the next step is linear in
//          the velocity.
#pragma once

#include "vo/filter/mixture.h"
#include "vo/filter/motion_model.h"
#include "vo/filter/path_prior.h"
#include "vo/filter/path_window.h"

namespace vo {

// mean + by_pose (poses - their means) + N(0, prior.last_covariance())
struct LastVelocity {
  Vector6 mean;  // (v in W, w in C)
  Eigen::Matrix<double, 6, Eigen::Dynamic> by_pose;
};

// `start`, `velocity`: the last sampled pose and the mean velocity there.
LastVelocity VelocityAtTheEnd(const PathPrior& prior, const Pose& start, const Vector6& velocity,
                              const PathGaussian& path);

// Last pose and velocity of the path: a component of the answer's mixture, its weight left open.
BeliefComponent ComponentAtTheEnd(const PathPrior& prior, const Pose& start, const Vector6& velocity,
                                  const PathGaussian& path);

// One pose more, a step after the end; `prior` is that of the path before. Nothing is solved: a pose that no image has
// seen changes no other.
void Extend(const PathPrior& prior, const MotionModel& step, const Pose& start, const Vector6& velocity,
            PathGaussian& path);
// The last pose integrated out.
void DropLast(PathGaussian& path);

}  // namespace vo
