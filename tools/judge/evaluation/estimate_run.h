// Purpose: what one run of an odometry left behind: estimate.txt, covariance.txt, frames.csv of docs/result_folder.md.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/judge/evaluation/trajectory.h"

namespace evaluation {

using Matrix12d = Eigen::Matrix<double, 12, 12>;

// Velocity and covariance of the whole state, in the order (dp in W, dphi in C, dv in W, dw in C).
struct StampedBelief {
  StampedVelocity velocity;  // with the stamp
  Matrix12d covariance = Matrix12d::Zero();
};

// Numerical events of a frame (vo/base/numerical_events.h).
struct GuardCounts {
  int unsettled = 0, behind = 0, indefinite = 0, impossible = 0;
};

// One line of frames.csv.
struct FrameRecord {
  std::int64_t stamp_ns = 0;
  int searched = 0;   // landmarks looked for
  int matched = 0;    // found
  int landmarks = 0;  // in the map
  int permanent = 0;
  double nis = 0;   // sum of nu' S^-1 nu over matched features
  int nis_dof = 0;  // 2 per matched feature
  double effective_particles = 0;
  double ms_features = 0, ms_matching = 0, ms_filter = 0;
  bool tracked = false;  // at least 10 matched features; else the filter coasted
  // None: not known, as of other people's systems and of results before these were counted
  std::optional<GuardCounts> guards;
};

struct EstimateRun {
  Trajectory trajectory;               // one pose per frame that has one
  std::vector<StampedBelief> beliefs;  // may be empty: no covariance, no consistency
  std::vector<FrameRecord> frames;     // may be empty: no coverage, no NIS. Else every frame of the sequence
};

// folder/estimate.txt is required, covariance.txt and frames.csv are read where they exist. Throws InputError with
// every problem of all three files at once.
EstimateRun ReadEstimateRun(const std::filesystem::path& folder);

// Writes the three files into folder, which must exist; empty parts are not written (and removed if a former run left
// them). Each file is written whole or not at all. Throws std::invalid_argument when a number is not finite,
// std::runtime_error when a file cannot be written.
void WriteEstimateRun(const std::filesystem::path& folder, const EstimateRun& run);

}  // namespace evaluation
