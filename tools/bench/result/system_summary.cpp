#include "tools/bench/result/system_summary.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "tools/bench/text.h"
#include "tools/judge/evaluation/statistics.h"

namespace vobench {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// The median over runs of what `value` says of each; NaN when any run has no answer.
template <class Value>
double MedianOver(const std::vector<const RunMetrics*>& runs, const Value& value) {
  std::vector<double> values;
  for (const RunMetrics* run : runs) values.push_back(value(*run));
  if (std::any_of(values.begin(), values.end(), [](double v) { return std::isnan(v); })) return kNaN;
  return evaluation::Median(values);
}

double PerDof(const std::optional<evaluation::NeesSummary>& nees) {
  return nees && nees->frames > 0 ? nees->mean / nees->dof : kNaN;
}

// The error part of a summary, over the trajectory that `of` picks.
template <class Errors>
SystemSummary ErrorsOver(const std::string& name, const std::vector<const RunMetrics*>& runs, const Errors& of) {
  SystemSummary s;
  s.system = name;
  s.runs = runs.size();
  const auto ate = [&](const RunMetrics& run) { return of(run).sim3.position.rmse; };
  s.ate_m = MedianOver(runs, ate);
  for (const RunMetrics* run : runs) s.ate_worst_m = std::max(s.ate_worst_m, ate(*run));
  s.ate_share_of_path = MedianOver(runs, [&](const RunMetrics& run) { return ate(run) / run.metrics.path_length_m; });
  s.ate_se3_m = MedianOver(runs, [&](const RunMetrics& run) { return of(run).se3.position.rmse; });
  s.scale = MedianOver(runs, [&](const RunMetrics& run) {
    const evaluation::Similarity& similarity = of(run).sim3.similarity;
    return similarity.scale_determined ? similarity.scale : kNaN;
  });
  const auto rpe = [&](const RunMetrics& run, bool position) {
    const evaluation::Rpe& r = of(run).rpe;
    return r.pairs.empty() ? kNaN : position ? r.position_statistics.rmse : r.orientation_statistics.rmse;
  };
  s.rpe_m = MedianOver(runs, [&](const RunMetrics& run) { return rpe(run, true); });
  s.rpe_rad = MedianOver(runs, [&](const RunMetrics& run) { return rpe(run, false); });
  s.pose_coverage = s.tracked_coverage = kNaN;
  s.nees_pose_per_dof = s.nees_pose_scale_free_per_dof = s.nees_velocity_per_dof = s.nis_per_dof = kNaN;
  return s;
}

SystemSummary Summary(const std::string& name, const std::vector<const RunMetrics*>& runs) {
  SystemSummary s = ErrorsOver(
      name, runs, [](const RunMetrics& run) -> const evaluation::TrajectoryErrors& { return run.metrics.errors; });
  s.pose_coverage = MedianOver(
      runs, [](const RunMetrics& run) { return run.metrics.coverage ? run.metrics.coverage->pose_coverage() : kNaN; });
  s.tracked_coverage = MedianOver(runs, [](const RunMetrics& run) {
    return run.metrics.coverage ? run.metrics.coverage->tracked_coverage().value_or(kNaN) : kNaN;
  });
  const auto nees = [&](const auto& member) {
    return MedianOver(runs, [&](const RunMetrics& run) {
      return run.metrics.consistency ? PerDof((*run.metrics.consistency).*member) : kNaN;
    });
  };
  s.nees_pose_per_dof = nees(&evaluation::ConsistencySummary::pose);
  s.nees_pose_scale_free_per_dof = nees(&evaluation::ConsistencySummary::pose_scale_free);
  s.nees_velocity_per_dof = nees(&evaluation::ConsistencySummary::velocity);
  s.nis_per_dof = MedianOver(runs, [](const RunMetrics& run) {
    return run.metrics.nis && run.metrics.nis->frames > 0 ? run.metrics.nis->mean_per_dof : kNaN;
  });
  return s;
}

}  // namespace

SystemSummary Summarise(const RunMetrics& run) { return Summary(run.run.system, {&run}); }

std::vector<SystemSummary> SummariseSystems(const std::vector<RunMetrics>& runs) {
  std::vector<std::string> systems;
  std::map<std::string, std::vector<const RunMetrics*>> runs_of;
  for (const RunMetrics& run : runs) {
    auto& own = runs_of[run.run.system];
    if (own.empty()) systems.push_back(run.run.system);
    own.push_back(&run);
  }
  std::vector<SystemSummary> summaries;
  for (const std::string& system : systems) summaries.push_back(Summary(system, runs_of[system]));
  return summaries;
}

std::vector<SystemSummary> SummariseBaselines(const std::vector<RunMetrics>& runs) {
  if (runs.empty()) return {};
  std::vector<const RunMetrics*> all;
  for (const RunMetrics& run : runs) all.push_back(&run);
  using Errors = evaluation::TrajectoryErrors;
  return {ErrorsOver("constant pose", all,
                     [](const RunMetrics& run) -> const Errors& { return run.metrics.constant_pose; }),
          ErrorsOver("constant velocity", all,
                     [](const RunMetrics& run) -> const Errors& { return run.metrics.constant_velocity; })};
}

Duel Compare(const std::vector<RunMetrics>& runs, const std::string& first, const std::string& second) {
  Duel duel;
  for (const RunMetrics& a : runs) {
    if (a.run.system != first) continue;
    for (const RunMetrics& b : runs) {
      if (b.run.system != second || b.run.seed != a.run.seed) continue;
      ++duel.seeds;
      duel.wins += a.metrics.errors.sim3.position.rmse < b.metrics.errors.sim3.position.rmse;
    }
  }
  return duel;
}

std::string TextSummary(const std::vector<RunMetrics>& runs) {
  if (runs.empty()) return "";
  std::vector<std::vector<std::string>> rows = {
      {"", "runs", "ATE", "worst", "of path", "RPE", "", "poses", "tracked", "NEES/dof", "scale-free", "NIS/dof"},
      {"", "", "[cm]", "[cm]", "[%]", "[cm/s]", "[deg/s]", "[%]", "[%]", "", "", ""}};
  const auto add = [&](const std::string& name, const SystemSummary& s, bool baseline) {
    rows.push_back({name, baseline ? "" : std::to_string(s.runs), Fixed(100 * s.ate_m, 2),
                    Fixed(100 * s.ate_worst_m, 2), Fixed(100 * s.ate_share_of_path, 2), Fixed(100 * s.rpe_m, 2),
                    Fixed(kDegrees * s.rpe_rad, 2), Fixed(100 * s.pose_coverage, 1), Fixed(100 * s.tracked_coverage, 1),
                    Readable(s.nees_pose_per_dof), Readable(s.nees_pose_scale_free_per_dof), Fixed(s.nis_per_dof, 2)});
  };
  for (const SystemSummary& s : SummariseSystems(runs)) add(DisplayName(s.system), s, false);
  for (const SystemSummary& s : SummariseBaselines(runs)) add(s.system, s, true);
  std::string text = AlignedTable(rows);
  const std::vector<SystemSummary> systems = SummariseSystems(runs);
  for (std::size_t i = 1; i < systems.size(); ++i) {
    const Duel duel = Compare(runs, systems[0].system, systems[i].system);
    if (duel.seeds == 0) continue;
    text += DisplayName(systems[0].system) + " has the smaller ATE in " + std::to_string(duel.wins) + " of " +
            std::to_string(duel.seeds) + " seeds against " + DisplayName(systems[i].system) + ".\n";
  }
  text +=
      "Medians over runs. ATE: position RMSE after Sim(3) alignment. RPE: over one second, scale of the alignment. "
      "tracked:\n"
      "frames with 10 or more matched features. NEES: of the pose, not aligned, 1 is ideal; scale-free: blind to the "
      "map's scale.\n";
  return text;
}

std::string TimeTable(const std::vector<evaluation::FrameRecord>& frames, double elapsed_s) {
  if (frames.empty()) return "";
  std::vector<std::vector<std::string>> rows = {{"Time per frame [ms]", "median", "95 %", "longest"}};
  const auto add = [&](const std::string& name, const auto& time_of) {
    std::vector<double> times;
    for (const evaluation::FrameRecord& frame : frames) times.push_back(time_of(frame));
    std::sort(times.begin(), times.end());
    rows.push_back({name, Fixed(evaluation::Quantile(times, 0.5), 2), Fixed(evaluation::Quantile(times, 0.95), 2),
                    Fixed(times.back(), 2)});
  };
  using Record = evaluation::FrameRecord;
  add("features", [](const Record& f) { return f.ms_features; });
  add("matching", [](const Record& f) { return f.ms_matching; });
  add("filter", [](const Record& f) { return f.ms_filter; });
  add("all", [](const Record& f) { return f.ms_features + f.ms_matching + f.ms_filter; });
  const double n = static_cast<double>(frames.size());
  return AlignedTable(rows) + std::to_string(frames.size()) + " frames in " + Fixed(elapsed_s, 2) +
         " s, read and tracked: " + Fixed(1e3 * elapsed_s / n, 2) + " ms each, " + Fixed(n / elapsed_s, 1) +
         " a second.\n";
}

}  // namespace vobench
