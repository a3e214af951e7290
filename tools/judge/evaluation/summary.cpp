#include "tools/judge/evaluation/summary.h"

#include <stdexcept>
#include <utility>

#include "tools/judge/evaluation/baseline.h"

namespace evaluation {
namespace {

using Stamps = std::vector<std::int64_t>;

Stamps FrameStamps(const EstimateRun& run, const JudgeOptions& options) {
  Stamps stamps;
  if (!run.frames.empty()) {
    for (const FrameRecord& frame : run.frames) stamps.push_back(frame.stamp_ns);
  } else if (options.frame_stamps_ns) {
    stamps = *options.frame_stamps_ns;
  } else {
    stamps = StampsOf(run.trajectory);
  }
  return stamps;
}

TrajectoryErrors ErrorsOf(const MatchedTrajectories& matched, std::size_t pairs_offered, const JudgeOptions& options) {
  TrajectoryErrors errors;
  errors.pairs = matched.estimate.size();
  errors.none = ComputeAte(matched, Alignment::none);
  errors.se3 = ComputeAte(matched, Alignment::se3);
  errors.sim3 = ComputeAte(matched, Alignment::sim3);
  errors.first = ComputeAte(matched, Alignment::first);
  const auto pairs = PairsByTime(matched.truth, options.rpe_delta_ns, options.rpe_tolerance_ns);
  errors.rpe = ComputeRpe(matched, pairs, errors.sim3.similarity.scale);
  errors.rpe_unscaled = ComputeRpe(matched, pairs, 1);
  errors.rpe_pairs_offered = pairs_offered;
  return errors;
}

std::optional<Coverage> CoverageOf(const EstimateRun& run, const JudgeOptions& options, const Stamps& frames) {
  if (run.frames.empty() && !options.frame_stamps_ns) return std::nullopt;
  Coverage coverage;
  coverage.frames = frames.size();
  // Each frame once, whatever rule the poses are judged by.
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
  std::vector<double> features, matching, filter;
  for (const FrameRecord& frame : frames) {
    features.push_back(frame.ms_features);
    matching.push_back(frame.ms_matching);
    filter.push_back(frame.ms_filter);
  }
  return Timing{Median(features), Median(matching), Median(filter)};
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

const Ate& TrajectoryErrors::Aligned(Alignment alignment) const {
  switch (alignment) {
    case Alignment::none:
      return none;
    case Alignment::se3:
      return se3;
    case Alignment::sim3:
      return sim3;
    case Alignment::first:
      return first;
  }
  throw std::logic_error("an alignment that was not computed");
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

  // What the truth offers on the frames of the sequence, whether the odometry answered or not.
  const Stamps frames = FrameStamps(run, options);
  Trajectory at_frames = ConstantPose(frames, {});
  const MatchedTrajectories offered = MatchTrajectories(at_frames, truth, options.association);
  const std::size_t pairs_offered = PairsByTime(offered.truth, options.rpe_delta_ns, options.rpe_tolerance_ns).size();

  const auto errors_of = [&](const Trajectory& estimate) {
    return ErrorsOf(MatchTrajectories(estimate, truth, options.association), pairs_offered, options);
  };
  MatchedTrajectories matched = MatchTrajectories(run.trajectory, truth, options.association);
  metrics.errors = ErrorsOf(matched, pairs_offered, options);
  series.aligned = Apply(metrics.errors.sim3.similarity, matched.estimate);
  series.truth = std::move(matched.truth);
  metrics.path_length_m = PathLength(offered.truth);
  metrics.duration_s = static_cast<double>(offered.truth.back().stamp_ns - offered.truth.front().stamp_ns) * 1e-9;

  const StampedPose& start = offered.truth.front();
  const auto given = truth_velocities ? VelocityAt(*truth_velocities, start.stamp_ns) : std::nullopt;
  metrics.constant_pose = errors_of(ConstantPose(frames, start));
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
