// Sampling of un-sampled poses: draws of one slot for all particles, the rest of a path given a pose, and the landmarks
// given a sampled pose.
// Source:  docs/algorithm.md, section 9.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "vo/base/random.h"
#include "vo/filter/rao_blackwell.h"
#include "vo/filter/window.h"

namespace vo {

// One pose for each particle from its marginal at `slot`; slots before it have been conditioned on. `exact`: draws of
// all particles together that are exact to second order (exact_draws.h), where there are enough.
std::vector<Pose> SamplePoses(const std::vector<PathSolution>& solutions, int slot, bool exact,
                              const std::function<RandomKey(std::size_t)>& key);

// The rest of the path given its pose at `slot`: a conditional Gaussian. The covariance loses that pose, the mean keeps
// it.
void ConditionOn(int slot, const Pose& pose, PathGaussian& path);

// Landmarks given one sampled pose and its matches, linearised at the modes.
void UpdateLandmarks(std::span<const Match> matches, const LandmarkTable& table, const Pose& pose,
                     std::span<const Pose> anchors, std::span<const Eigen::Vector3d> modes,
                     std::vector<Landmark>& landmarks);

// The particle given the sampled pose at `slot` of its path: velocity (37)-(43), then landmarks. Its pose becomes that
// one.
void UpdateGivenPose(const CameraVelocityFilter& step, std::span<const Match> matches, const LandmarkTable& table,
                     int slot, const PathSolution& solution, Particle& particle);

}  // namespace vo
