#include "tools/bench/result/system_summary.h"

#include <algorithm>
#include <cmath>

#include "tools/bench/text.h"
#include "tools/judge/evaluation/statistics.h"

namespace vobench {
namespace {

using Runs = std::vector<SystemSummary>;

double PerDof(const std::optional<evaluation::NeesSummary>& nees) {
  return nees && nees->frames > 0 ? nees->mean / nees->dof : kNaN;
}

SystemSummary ErrorsOf(const std::string& name, const RunMetrics& run, const evaluation::TrajectoryErrors& errors) {
  SystemSummary s;
  s.system = name;
  s.runs = 1;
  if (!errors.determines_alignment()) return s;
  s.ate_m = s.ate_worst_m = errors.sim3.position.rmse;
  s.ate_share_of_path = s.ate_m / run.metrics.path_length_m;
  s.ate_se3_m = errors.se3.position.rmse;
  if (errors.sim3.similarity.scale_determined) s.scale = errors.sim3.similarity.scale;
  if (errors.rpe.pairs.empty()) return s;
  s.rpe_m = errors.rpe.position_statistics.rmse;
  s.rpe_rad = errors.rpe.orientation_statistics.rmse;
  return s;
}

// NaN when any run has no answer.
SystemSummary MedianOf(const Runs& runs) {
  using S = SystemSummary;
  S s = runs.front();
  s.runs = runs.size();
  s.ate_worst_m = 0;
  for (const S& run : runs) s.ate_worst_m = std::isnan(run.ate_m) ? kNaN : std::max(s.ate_worst_m, run.ate_m);
  for (double S::*const member : {&S::ate_m, &S::ate_live_m, &S::ate_share_of_path, &S::ate_se3_m, &S::scale, &S::rpe_m,
                                  &S::rpe_rad, &S::pose_coverage, &S::tracked_coverage, &S::nees_pose_per_dof,
                                  &S::nees_pose_scale_free_per_dof, &S::nees_velocity_per_dof, &S::nis_per_dof}) {
    std::vector<double> values;
    for (const S& run : runs) values.push_back(run.*member);
    const bool complete = std::ranges::none_of(values, [](double value) { return std::isnan(value); });
    s.*member = complete ? evaluation::Median(values) : kNaN;
  }
  return s;
}

}  // namespace

SystemSummary Summarise(const RunMetrics& run) {
  const evaluation::Metrics& m = run.metrics;
  SystemSummary s = ErrorsOf(run.run.system, run, m.errors);
  if (m.live && m.live->determines_alignment()) s.ate_live_m = m.live->sim3.position.rmse;
  if (m.coverage) {
    s.pose_coverage = m.coverage->pose_coverage();
    s.tracked_coverage = m.coverage->tracked_coverage().value_or(kNaN);
  }
  if (m.consistency) {
    s.nees_pose_per_dof = PerDof(m.consistency->pose);
    s.nees_pose_scale_free_per_dof = PerDof(m.consistency->pose_scale_free);
    s.nees_velocity_per_dof = PerDof(m.consistency->velocity);
  }
  if (m.nis && m.nis->frames > 0) s.nis_per_dof = m.nis->mean_per_dof;
  return s;
}

std::vector<SystemSummary> SummariseSystems(const std::vector<RunMetrics>& runs) {
  std::vector<Runs> systems;
  for (const RunMetrics& run : runs) {
    auto own = std::ranges::find(systems, run.run.system, [](const Runs& all) { return all.front().system; });
    if (own == systems.end()) own = systems.emplace(own);
    own->push_back(Summarise(run));
  }
  std::vector<SystemSummary> summaries;
  for (const Runs& own : systems) summaries.push_back(MedianOf(own));
  return summaries;
}

std::vector<SystemSummary> SummariseBaselines(const std::vector<RunMetrics>& runs) {
  if (runs.empty()) return {};
  Runs still, steady;
  for (const RunMetrics& run : runs) {
    still.push_back(ErrorsOf("constant pose", run, run.metrics.constant_pose));
    steady.push_back(ErrorsOf("constant velocity", run, run.metrics.constant_velocity));
  }
  return {MedianOf(still), MedianOf(steady)};
}

PairwiseComparison Compare(const std::vector<RunMetrics>& runs, const std::string& first, const std::string& second) {
  PairwiseComparison pair;
  for (const RunMetrics& a : runs) {
    if (a.run.system != first) continue;
    for (const RunMetrics& b : runs) {
      if (b.run.system != second || b.run.seed != a.run.seed) continue;
      ++pair.seeds;
      pair.wins += a.metrics.errors.sim3.position.rmse < b.metrics.errors.sim3.position.rmse;
    }
  }
  return pair;
}

std::string TextSummary(const std::vector<RunMetrics>& runs) {
  if (runs.empty()) return "";
  std::vector<std::vector<std::string>> rows = {
      {"", "runs", "ATE", "live", "worst", "of path", "RPE", "", "poses", "tracked", "NEES/dof", "scale-free",
       "NIS/dof"},
      {"", "", "[cm]", "[cm]", "[cm]", "[%]", "[cm/s]", "[deg/s]", "[%]", "[%]", "", "", ""}};
  const auto add = [&](const std::string& name, const SystemSummary& s, bool baseline) {
    rows.push_back({name, baseline ? "" : std::to_string(s.runs), Fixed(100 * s.ate_m, 2), Fixed(100 * s.ate_live_m, 2),
                    Fixed(100 * s.ate_worst_m, 2), Fixed(100 * s.ate_share_of_path, 2), Fixed(100 * s.rpe_m, 2),
                    Fixed(kDegrees * s.rpe_rad, 2), Fixed(100 * s.pose_coverage, 1), Fixed(100 * s.tracked_coverage, 1),
                    Readable(s.nees_pose_per_dof), Readable(s.nees_pose_scale_free_per_dof), Fixed(s.nis_per_dof, 2)});
  };
  for (const SystemSummary& s : SummariseSystems(runs)) add(DisplayName(s.system), s, false);
  for (const SystemSummary& s : SummariseBaselines(runs)) add(s.system, s, true);
  std::string text = AlignedTable(rows);
  const std::vector<SystemSummary> systems = SummariseSystems(runs);
  for (std::size_t i = 1; i < systems.size(); ++i) {
    const PairwiseComparison pair = Compare(runs, systems[0].system, systems[i].system);
    if (pair.seeds == 0) continue;
    text += DisplayName(systems[0].system) + " has the smaller ATE in " + std::to_string(pair.wins) + " of " +
            std::to_string(pair.seeds) + " seeds against " + DisplayName(systems[i].system) + ".\n";
  }
  for (const SystemSummary& s : systems)
    if (s.tracked_coverage == 0)
      text += DisplayName(s.system) + " tracked no frame: all its answers are predictions (docs/troubleshooting.md).\n";
  text +=
      "Medians over runs. ATE: position RMSE after Sim(3) alignment; live: of the answers as they were given. "
      "RPE: over one\nsecond, scale of the alignment. tracked: frames in which at least 10, and 40 % of the searched, "
      "features match at the\nfirst prediction. NEES: of the pose, live, " +
      std::string(Name(runs[0].metrics.options.gauge)) +
      ", 1 is ideal; scale-free: blind to the\nmap's scale. Baselines: from the true pose; constant velocity with the "
      "true velocity too.\n";
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
