// Run folder of an odometry: estimate.txt, live.txt, covariance.txt, frames.csv (docs/result_folder.md).
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "tools/judge/evaluation/trajectory.h"

namespace evaluation {

using Matrix12d = Eigen::Matrix<double, 12, 12>;

// Velocity and covariance of the whole state, in the order (dp in W, dphi in C, dv in W, dw in C).
struct StampedBelief {
  StampedVelocity velocity;  // with the stamp
  Matrix12d covariance = Matrix12d::Zero();
};

// Numerical events of a filter: counts per frame of departures from its equations (docs/odometry.md).
struct NumericalEvents {
  int not_converged = 0, behind_camera = 0, not_positive_definite = 0, non_finite_weight = 0;
};
// Their names as columns of frames.csv and keys of metrics.json, once.
struct NumericalEvent {
  const char* name;
  int NumericalEvents::*count;
};
inline constexpr std::array<NumericalEvent, 4> kNumericalEvents = {
    {{"not_converged", &NumericalEvents::not_converged},
     {"behind_camera", &NumericalEvents::behind_camera},
     {"not_positive_definite", &NumericalEvents::not_positive_definite},
     {"non_finite_weight", &NumericalEvents::non_finite_weight}}};

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
  bool tracked = false;                   // docs/metrics.md, "Coverage"; by the rule of the program that wrote it
  std::optional<NumericalEvents> events;  // none where unknown, as for external systems
  std::optional<int> repeated;            // predictions made again in this frame; none as well
};

struct EstimateRun {
  Trajectory trajectory;  // one pose per frame that has one, re-issued ones in the place of the answers
  Trajectory live;        // the answers as they were given; may be empty: those are not known, or the trajectory itself
  std::vector<StampedBelief> beliefs;  // of the answers; may be empty: no covariance, no consistency
  std::vector<FrameRecord> frames;     // may be empty: no coverage, no NIS. Else every frame of the sequence

  const Trajectory& answers() const { return live.empty() ? trajectory : live; }
};

// The run as if its sequence did not have the frames of [from_ns, until_ns).
EstimateRun Outside(EstimateRun run, std::int64_t from_ns, std::int64_t until_ns);

// folder/estimate.txt is required, the others are read where they exist. Throws InputError with every problem of all
// files at once.
EstimateRun ReadEstimateRun(const std::filesystem::path& folder);

// Writes the files into folder, which must exist; empty parts are not written (and removed if a former run left
// them). Each file is written whole or not at all. Throws std::invalid_argument when a number is not finite,
// std::runtime_error when a file cannot be written.
void WriteEstimateRun(const std::filesystem::path& folder, const EstimateRun& run);

}  // namespace evaluation
