#include "tools/judge/evaluation/summary.h"

#include <cmath>
#include <utility>

#include "tools/judge/evaluation/so3.h"

namespace evaluation {
namespace {

using Stamps = std::vector<std::int64_t>;

Stamps FrameStamps(const EstimateRun& run, const JudgeOptions& options) {
  if (run.frames.empty()) return options.frame_stamps_ns.value_or(StampsOf(run.trajectory));
  Stamps stamps;
  for (const FrameRecord& frame : run.frames) stamps.push_back(frame.stamp_ns);
  return stamps;
}

TrajectoryErrors ErrorsOf(const MatchedTrajectories& matched, std::size_t pairs_offered, const JudgeOptions& options) {
  using enum Alignment;
  const auto ate = [&](Alignment alignment) { return ComputeAte(matched, alignment); };
  const Ate scaled = ate(sim3);
  const auto pairs = PairsByTime(matched.truth, options.rpe_delta_ns, options.rpe_tolerance_ns);
  const Rpe rpe = ComputeRpe(matched, pairs, scaled.similarity.scale), unscaled = ComputeRpe(matched, pairs);
  const std::size_t n = matched.estimate.size();
  return {n, ate(none), ate(se3), scaled, ate(first), ate(yaw), rpe, unscaled, pairs_offered};
}

std::optional<Coverage> CoverageOf(const EstimateRun& run, const JudgeOptions& options, const Stamps& frames) {
  if (run.frames.empty() && !options.frame_stamps_ns) return std::nullopt;
  Coverage coverage;
  coverage.frames = frames.size();
  // Each frame counts once, whatever the association of poses.
  coverage.with_pose =
      Associate(StampsOf(run.trajectory), frames, {AssociationRule::one_to_one, options.association.gap_ns}).size();
  if (!run.frames.empty()) {
    coverage.tracked = 0;
    for (const FrameRecord& frame : run.frames) *coverage.tracked += frame.tracked;
  }
  return coverage;
}

ConsistencySummary Summarised(const std::vector<FrameConsistency>& frames, bool with_velocity) {
  const auto summarise = [&](double FrameConsistency::*member, int dof) {
    std::vector<double> values;
    for (const FrameConsistency& frame : frames) values.push_back(frame.*member);
    return SummariseNees(values, dof);
  };
  ConsistencySummary summary;
  summary.pose = summarise(&FrameConsistency::nees_pose, 6);
  summary.pose_scale_free = summarise(&FrameConsistency::nees_pose_scale_free, 5);
  if (with_velocity) {
    summary.velocity = summarise(&FrameConsistency::nees_velocity, 6);
    summary.joint = summarise(&FrameConsistency::nees_joint, 12);
    summary.joint_scale_free = summarise(&FrameConsistency::nees_joint_scale_free, 11);
  }
  return summary;
}

std::optional<Timing> TimingOf(const std::vector<FrameRecord>& frames) {
  if (frames.empty()) return std::nullopt;
  const auto median = [&](double FrameRecord::*member) {
    std::vector<double> values;
    for (const FrameRecord& frame : frames) values.push_back(frame.*member);
    return Median(values);
  };
  return Timing{median(&FrameRecord::ms_features), median(&FrameRecord::ms_matching), median(&FrameRecord::ms_filter)};
}

std::optional<EventSummary> EventsOf(const std::vector<FrameRecord>& frames) {
  if (frames.empty()) return std::nullopt;
  EventSummary summary;
  for (const FrameRecord& frame : frames) {
    if (!frame.events) return std::nullopt;
    for (std::size_t i = 0; i < summary.size(); ++i) {
      const int times = (*frame.events).*kNumericalEvents[i].count;
      summary[i].times += times;
      summary[i].frames += times > 0;
    }
  }
  return summary;
}

}  // namespace

Trajectory ConstantVelocity(const std::vector<std::int64_t>& stamps_ns, const StampedPose& start,
                            const StampedVelocity& velocity) {
  Trajectory trajectory;
  for (const std::int64_t stamp : stamps_ns) {
    const double dt = static_cast<double>(stamp - start.stamp_ns) * 1e-9;
    trajectory.push_back({stamp, start.p_WC + velocity.v_WC * dt, start.q_WC * Exp(velocity.w_WC_C * dt)});
  }
  return trajectory;
}

StampedVelocity StartVelocity(const Trajectory& trajectory) {
  StampedVelocity velocity;
  if (trajectory.empty()) return velocity;
  const StampedPose& first = trajectory.front();
  velocity.stamp_ns = first.stamp_ns;
  std::size_t i = 0;
  while (i + 1 < trajectory.size() && trajectory[i].stamp_ns - first.stamp_ns < 100'000'000) ++i;
  if (i == 0) return velocity;
  const double dt = static_cast<double>(trajectory[i].stamp_ns - first.stamp_ns) * 1e-9;
  velocity.v_WC = (trajectory[i].p_WC - first.p_WC) / dt;
  velocity.w_WC_C = Log(first.q_WC.conjugate() * trajectory[i].q_WC) / dt;
  return velocity;
}

const Ate& TrajectoryErrors::Aligned(Alignment alignment) const {
  const std::array all = {&none, &se3, &sim3, &first, &yaw};
  return *all.at(static_cast<std::size_t>(alignment));
}

bool TiltsZ(const TrajectoryErrors& errors) {
  return errors.se3.similarity.rotation_determined && errors.se3.similarity.R(2, 2) < std::sqrt(0.5);
}

double Coverage::pose_coverage() const {
  return frames == 0 ? 0 : static_cast<double>(with_pose) / static_cast<double>(frames);
}

std::optional<double> Coverage::tracked_coverage() const {
  if (!tracked) return std::nullopt;
  return frames == 0 ? 0 : static_cast<double>(*tracked) / static_cast<double>(frames);
}

JudgedSeries JudgeSeries(const EstimateRun& run, const Trajectory& truth,
                         const std::optional<Velocities>& truth_velocities, const JudgeOptions& options) {
  JudgedSeries series;
  Metrics& metrics = series.metrics;
  metrics.options = options;

  // Pairs of the truth on the frames of the sequence, answered or not.
  const Stamps frames = FrameStamps(run, options);
  Trajectory at_frames = ConstantVelocity(frames, {});
  const MatchedTrajectories offered = MatchTrajectories(at_frames, truth, options.association);
  const std::size_t pairs_offered = PairsByTime(offered.truth, options.rpe_delta_ns, options.rpe_tolerance_ns).size();

  const auto errors_of = [&](const Trajectory& estimate) {
    return ErrorsOf(MatchTrajectories(estimate, truth, options.association), pairs_offered, options);
  };
  MatchedTrajectories matched = MatchTrajectories(run.trajectory, truth, options.association);
  metrics.errors = ErrorsOf(matched, pairs_offered, options);
  if (!run.live.empty()) metrics.live = errors_of(run.live);
  series.aligned = Apply(metrics.errors.sim3.similarity, matched.estimate);
  series.truth = std::move(matched.truth);
  metrics.path_length_m = PathLength(offered.truth);
  metrics.spread_m = Spread(offered.truth);
  metrics.duration_s = static_cast<double>(offered.truth.back().stamp_ns - offered.truth.front().stamp_ns) * 1e-9;

  const StampedPose& start = offered.truth.front();
  const auto given = truth_velocities ? VelocityAt(*truth_velocities, start.stamp_ns) : std::nullopt;
  metrics.constant_pose = errors_of(ConstantVelocity(frames, start));
  metrics.constant_velocity = errors_of(ConstantVelocity(frames, start, given.value_or(StartVelocity(offered.truth))));

  metrics.coverage = CoverageOf(run, options, frames);
  if (!run.beliefs.empty()) {
    series.consistency = ComputeConsistency(run, truth, truth_velocities, options.association.gap_ns, options.gauge);
    metrics.consistency = Summarised(series.consistency, truth_velocities.has_value());
  }
  if (!run.frames.empty()) metrics.nis = SummariseNis(run.frames);
  metrics.timing = TimingOf(run.frames);
  metrics.events = EventsOf(run.frames);
  return series;
}

Metrics Judge(const EstimateRun& run, const Trajectory& truth, const std::optional<Velocities>& truth_velocities,
              const JudgeOptions& options) {
  return JudgeSeries(run, truth, truth_velocities, options).metrics;
}

}  // namespace evaluation
