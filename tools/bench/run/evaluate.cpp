#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "tools/bench/errors.h"
#include "tools/bench/result/metrics_json.h"
#include "tools/bench/result/result.h"
#include "tools/bench/run/commands.h"
#include "tools/bench/run/run_common.h"
#include "tools/bench/sequence/sequence_truth.h"
#include "tools/bench/text.h"
#include "tools/judge/evaluation/summary.h"
#include "vo/sequence/reader.h"

namespace vobench {
namespace fs = std::filesystem;
namespace {

using evaluation::Statistics;

constexpr const char* kNees = "NEES of the pose, per dof";

// A run folder with all that it has, or a trajectory alone.
evaluation::EstimateRun ReadEstimate(const fs::path& path) {
  if (fs::is_directory(path) && !fs::exists(path / "estimate.txt") && fs::exists(path / kResultMarker)) {
    std::vector<std::string> runs;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(path))
      if (entry.path().filename() == "estimate.txt") runs.push_back(entry.path().parent_path().string());
    std::ranges::sort(runs);
    throw BadInput(fmt::format("{} holds {}: name one{}", path.string(), Count(runs.size(), "run"),
                               runs.empty() ? "" : ", such as " + runs.front()));
  }
  if (fs::exists(path / "campaign.json"))
    throw BadInput(path.string() + ": is a campaign's folder, with the errors of its tasks in results.csv");
  if (fs::is_directory(path) && !fs::exists(path / "estimate.txt"))
    throw BadInput(path.string() +
                   ": has no estimate.txt: ESTIMATE is a run folder or a trajectory, the sequence "
                   "belongs after --truth");
  if (fs::is_directory(path)) return evaluation::ReadEstimateRun(path);
  evaluation::EstimateRun run;
  run.trajectory = evaluation::ReadTrajectory(path);
  return run;
}

// Options with which a run was evaluated, which determine its world frame: from the metrics.json of its own folder or,
// as `run` leaves it, of one further up. None where none names it.
std::optional<evaluation::JudgeOptions> RecordedOptions(const fs::path& run) {
  const fs::path folder = fs::canonical(run);
  for (fs::path result = folder; result.has_relative_path(); result = result.parent_path()) {
    if (!fs::exists(result / "metrics.json") || (result != folder && !fs::exists(result / kResultMarker))) continue;
    for (const RecordedMetrics& recorded : ReadMetricsJson(result)) {
      if (fs::weakly_canonical(result / recorded.path) == folder) return recorded.options;
    }
  }
  return std::nullopt;
}

// Of a file or a sequence.
evaluation::Trajectory ReadTruth(const fs::path& path, evaluation::Reading reading = evaluation::Reading::strict) {
  if (!fs::is_directory(path)) return evaluation::ReadTrajectory(path, reading);
  if (const std::string problem = vo::RigProblem(path); !problem.empty())
    throw BadInput(fmt::format("{}, or {} for poses of the body", problem, (path / "groundtruth.txt").string()));
  const fs::path file = path / "groundtruth.txt";
  if (reading != evaluation::Reading::strict && fs::exists(file)) return evaluation::ReadTrajectory(file, reading);
  const std::optional<Truth> truth = ReadSequenceTruth(path);
  if (!truth)
    throw BadInput(
        fmt::format("{}: no groundtruth.txt in it, nor mav0/state_groundtruth_estimate0/data.csv, "
                    "mav0/mocap0/data.csv or *.gt.freiburg",
                    path.string()));
  return truth->poses;
}

// Of a file, a run folder or a sequence.
evaluation::Trajectory ReadEstimatedPoses(const fs::path& path, evaluation::Reading reading) {
  const fs::path file = path / "estimate.txt";
  return fs::exists(file) ? evaluation::ReadTrajectory(file, reading) : ReadTruth(path, reading);
}

void PrintStatistics(std::string_view what, const Statistics& s, double factor, std::string_view unit) {
  fmt::print("{:<28} rmse {:9.4f}  mean {:9.4f}  median {:9.4f}  max {:9.4f}  [{}]\n", what, factor * s.rmse,
             factor * s.mean, factor * s.median, factor * s.max, unit);
}

void PrintNees(const evaluation::NeesSummary& nees, evaluation::Gauge gauge) {
  if (nees.frames == 0) {
    fmt::print("{:<28} none: no frame has a covariance that is positive definite\n", kNees);
    return;
  }
  fmt::print("{:<28} {:.3f}  (ideal 1; {})\n", kNees, nees.mean / nees.dof, Name(gauge));
}

void Print(const evaluation::Metrics& metrics, evaluation::Alignment alignment) {
  const evaluation::TrajectoryErrors& errors = metrics.errors;
  const evaluation::Ate& ate = errors.Aligned(alignment);
  const evaluation::Rpe& rpe = alignment == evaluation::Alignment::sim3 ? errors.rpe : errors.rpe_unscaled;
  fmt::print("{} poses associated (within {:.0f} ms), {:.3f} m of path in {:.3f} s\n", errors.pairs,
             static_cast<double>(metrics.options.association.gap_ns) * 1e-6, metrics.path_length_m, metrics.duration_s);
  fmt::print("alignment: {}, scale {:.6f}\n", evaluation::Name(alignment), ate.similarity.scale);
  PrintStatistics("ATE position", ate.position, 100, "cm");
  if (metrics.live) PrintStatistics("ATE of the live answers", metrics.live->Aligned(alignment).position, 100, "cm");
  if (ate.orientation.count > 0) PrintStatistics("ATE orientation", ate.orientation, kDegrees, "deg");
  if (rpe.position_statistics.count > 0) {
    PrintStatistics("RPE position, per second", rpe.position_statistics, 100, "cm/s");
    PrintStatistics("RPE orientation, per second", rpe.orientation_statistics, kDegrees, "deg/s");
  }
  PrintStatistics("ATE of a constant pose", metrics.constant_pose.Aligned(alignment).position, 100, "cm");
  if (metrics.coverage) {
    fmt::print("{:<28} {:.4f}  (of {} frames)\n", "pose coverage", metrics.coverage->pose_coverage(),
               metrics.coverage->frames);
    if (const auto tracked = metrics.coverage->tracked_coverage())
      fmt::print("{:<28} {:.4f}\n", "tracked coverage", *tracked);
  }
  if (metrics.consistency) PrintNees(metrics.consistency->pose, metrics.options.gauge);
  if (!metrics.nis) return;
  if (metrics.nis->frames == 0) {
    fmt::print("{:<28} none: no frame has a matched feature\n", "NIS, per dof");
  } else {
    fmt::print("{:<28} {:.3f}  (ideal 1)\n", "NIS, per dof", metrics.nis->mean_per_dof);
  }
}

// Checks that the alignment is determined: else the best fit has no information on the estimate.
void CheckBasis(const evaluation::TrajectoryErrors& errors, const evaluation::Metrics& metrics,
                evaluation::Alignment alignment) {
  const auto warn = [](std::string_view what) { fmt::print(stderr, "vobench: warning: {}\n", what); };
  const bool fitted = alignment != evaluation::Alignment::none && alignment != evaluation::Alignment::first;
  if (const std::string problem = AlignmentProblem(metrics); !problem.empty()) {
    if (alignment != evaluation::Alignment::none) throw BadInput(problem);
    warn(problem);
  }
  if (!fitted) return;
  const evaluation::Ate& ate = errors.Aligned(alignment);
  if (alignment == evaluation::Alignment::sim3 && !ate.similarity.scale_determined)
    throw BadInput("the true or the estimated positions do not move: --align sim3 has no scale; use se3 or first");
  if (alignment == evaluation::Alignment::yaw && evaluation::TiltsZ(errors))
    warn("a rotation that fits turns z by more than 45 degrees: --align yaw is for worlds whose z is up in both");
  if (!ate.similarity.rotation_determined)
    warn(
        fmt::format("the rotation is not determined, nor are orientation errors: the positions lie on one line or "
                    "point, but for the error of {:.3g} cm{}",
                    100 * ate.position.rmse,
                    alignment == evaluation::Alignment::sim3 ? "" : " (is the scale unknown? --align sim3)"));
  if (alignment == evaluation::Alignment::sim3 &&
      ate.position.rmse > 0.9 * metrics.constant_pose.Aligned(alignment).position.rmse)
    warn("the estimate explains none of the true motion: the best scale shrinks it to nearly a point");
}

}  // namespace

void Evaluate(const EvaluateOptions& options) {
  if (options.compat) {
    const Reproduction& tool = *options.compat;
    fmt::print("{}", Input([&] {
                 return tool.Run(ReadEstimatedPoses(options.estimate, tool.reading),
                                 ReadTruth(options.truth, tool.reading));
               }));
    return;
  }
  evaluation::EstimateRun estimate = Input([&] { return ReadEstimate(options.estimate); });
  const evaluation::Trajectory truth = Input([&] { return ReadTruth(options.truth); });
  const auto recorded =
      estimate.beliefs.empty() ? std::nullopt : Input([&] { return RecordedOptions(options.estimate); });
  const bool world_is_known = estimate.beliefs.empty() || recorded;
  if (!world_is_known) estimate.beliefs.clear();
  auto how = recorded.value_or(evaluation::JudgeOptions{});
  if (fs::is_directory(options.truth)) how.frame_stamps_ns = Input([&] { return ReadFrameStamps(options.truth); });
  const evaluation::Metrics metrics = Input([&] { return evaluation::Judge(estimate, truth, std::nullopt, how); });
  const evaluation::Alignment alignment = evaluation::AlignmentNamed(options.align);
  CheckBasis(metrics.errors, metrics, alignment);
  Print(metrics, alignment);
  if (!world_is_known) {
    fmt::print("{:<28} none: without the metrics.json of this run nothing says whether it began in the truth's world\n",
               kNees);
  }
}

}  // namespace vobench
