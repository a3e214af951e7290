// Metrics of one run: all metrics of the evaluation, with its options (docs/metrics.md).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "tools/judge/evaluation/ate.h"
#include "tools/judge/evaluation/consistency.h"
#include "tools/judge/evaluation/estimate_run.h"
#include "tools/judge/evaluation/rpe.h"
#include "tools/judge/evaluation/whiteness.h"

namespace evaluation {

// Baseline without images: the true start pose moved on with constant v (in W) and constant w (in C), at each stamp.
Trajectory ConstantVelocity(const std::vector<std::int64_t>& stamps_ns, const StampedPose& start,
                            const StampedVelocity& velocity = {});

// The velocity at the start of a trajectory: mean over its first 0.1 s (to the first pose at least so much later; to
// the last if none is). Zero for a single pose.
StampedVelocity StartVelocity(const Trajectory& trajectory);

struct JudgeOptions {
  AssociationOptions association;
  std::int64_t rpe_delta_ns = 1'000'000'000;
  std::int64_t rpe_tolerance_ns = 50'000'000;
  Gauge gauge = Gauge::as_is;  // of NEES only
  // Stamps of all frames of the sequence, for pose coverage, where the run has no frames.csv.
  std::optional<std::vector<std::int64_t>> frame_stamps_ns;
};

// Errors of a trajectory against the truth.
struct TrajectoryErrors {
  std::size_t pairs = 0;            // associated
  Ate none, se3, sim3, first, yaw;  // by alignment
  Rpe rpe;                          // estimate's translations times sim3's scale
  Rpe rpe_unscaled;                 // as they are
  // How many pairs the truth offers on the frames of the sequence; rpe.pairs has those answered
  std::size_t rpe_pairs_offered = 0;
  bool determines_alignment() const { return pairs >= 3; }  // fewer leave no error after it
  const Ate& Aligned(Alignment alignment) const;
};

// Whether the best rotation turns the estimate's z by more than 45 degrees: `yaw`'s assumption is violated.
bool TiltsZ(const TrajectoryErrors& errors);

struct Coverage {
  std::size_t frames = 0;
  std::size_t with_pose = 0;
  std::optional<std::size_t> tracked;  // frames; none where the run does not record it
  double pose_coverage() const;
  std::optional<double> tracked_coverage() const;
};

struct ConsistencySummary {
  NeesSummary pose, pose_scale_free;
  std::optional<NeesSummary> velocity, joint, joint_scale_free;  // where true velocities are known
};

struct Timing {
  double ms_features = 0, ms_matching = 0, ms_filter = 0;  // medians over frames
};

// Numerical events of a run, in the order of kNumericalEvents.
struct EventCount {
  std::int64_t times = 0;
  std::size_t frames = 0;  // with at least one
};
using EventSummary = std::array<EventCount, kNumericalEvents.size()>;

struct Metrics {
  JudgeOptions options;
  double path_length_m = 0;                           // of the truth at the frames of the sequence
  double spread_m = 0;                                // RMS distance of these positions from their mean
  double duration_s = 0;                              // between the first and the last of these
  TrajectoryErrors errors;                            // of the trajectory
  std::optional<TrajectoryErrors> live;               // of the answers as they were given, where the run has them apart
  TrajectoryErrors constant_pose, constant_velocity;  // baselines, from the true start, on all frames
  std::optional<Coverage> coverage;
  std::optional<ConsistencySummary> consistency;
  std::optional<NisSummary> nis;
  std::optional<Timing> timing;
  std::optional<EventSummary> events;  // where all frames have them
};

// Metrics of a run and the series per frame behind them: pose k of `aligned` belongs to pose k of `truth`.
struct JudgedSeries {
  Metrics metrics;
  Trajectory aligned, truth;                  // aligned by Sim(3), in the truth's world
  std::vector<FrameConsistency> consistency;  // not aligned; empty without covariances
};

// Throws InputError when estimate and truth do not overlap in time.
JudgedSeries JudgeSeries(const EstimateRun& run, const Trajectory& truth,
                         const std::optional<Velocities>& truth_velocities, const JudgeOptions& options = {});
// Its metrics alone.
Metrics Judge(const EstimateRun& run, const Trajectory& truth, const std::optional<Velocities>& truth_velocities,
              const JudgeOptions& options = {});

}  // namespace evaluation
