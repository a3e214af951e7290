#include "tools/bench/report/summary.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "tools/bench/report/html.h"
#include "tools/bench/result/system_summary.h"
#include "tools/bench/text.h"

namespace vobench::report {
namespace {

namespace ev = evaluation;

// Consistency in words from the mean NEES per degree of freedom, with and without the error of scale.
std::string ConsistencyPhrase(const SystemSummary& s) {
  const double nees = s.nees_pose_per_dof;
  if (!std::isfinite(nees)) return "its uncertainty was not judged";
  std::string text;
  if (nees > 1.5) {
    text = "it is over-confident: errors are about " + Readable(std::sqrt(nees)) + " times its standard deviations";
  } else if (nees < 1 / 1.5) {
    text = "it is under-confident (conservative): errors are about " + Readable(std::sqrt(nees)) +
           " times its standard deviations";
  } else {
    text = "its errors are about as large as its standard deviations";
  }
  text += " (NEES " + Readable(nees) + " per degree of freedom, 1 is ideal";
  if (std::isfinite(s.nees_pose_scale_free_per_dof)) {
    text += "; " + Readable(s.nees_pose_scale_free_per_dof) + " when the scale of the map is not counted";
  }
  return text + ")";
}

std::string SystemSentence(const SystemSummary& s, const std::vector<SystemSummary>& baselines) {
  std::string text = "<b>" + Escape(DisplayName(s.system)) + "</b>, " + Count(s.runs, "run") + ": ";
  text += s.runs > 1 ? "median ATE " : "ATE ";
  text += "<b>" + Fixed(100 * s.ate_m, 2) + " cm</b> (" + Percent(s.ate_share_of_path, 2) + " of the path";
  if (std::isfinite(s.ate_live_m)) text += "; live answers " + Fixed(100 * s.ate_live_m, 2) + " cm";
  if (s.runs > 1) text += "; worst run " + Fixed(100 * s.ate_worst_m, 2) + " cm";
  text += std::isfinite(s.rpe_m)
              ? "), drift " + Fixed(100 * s.rpe_m, 2) + " cm/s and " + Fixed(kDegrees * s.rpe_rad, 2) + " °/s, "
              : "), no drift (it lasts less than a second), ";
  text += Percent(s.tracked_coverage) + " of the frames tracked; " + ConsistencyPhrase(s) + ". ";
  const double best = std::min(baselines[0].ate_m, baselines[1].ate_m);
  text += s.ate_m < best ? "The better baseline has " + Readable(best / s.ate_m) + " times its ATE."
                         : "<b>Its ATE is not below that of the better baseline, which starts at the true pose and "
                           "has no images.</b>";
  return text;
}

std::string PairwiseSentence(const std::vector<RunMetrics>& runs, const SystemSummary& a, const SystemSummary& b) {
  const PairwiseComparison pair = Compare(runs, a.system, b.system);
  if (pair.seeds == 0) return "";
  const std::string first = Escape(DisplayName(a.system)), second = Escape(DisplayName(b.system));
  std::string text = first + " has the smaller ATE in <b>" + std::to_string(pair.wins) + " of " +
                     Count(pair.seeds, "seed") + "</b> against " + second + "; medians " + Fixed(100 * a.ate_m, 2) +
                     " and " + Fixed(100 * b.ate_m, 2) + " cm.";
  if (a.ate_m >= b.ate_m || 2 * pair.wins <= pair.seeds)
    text += " <b>" + first + " does not beat " + second + " here.</b>";
  return text;
}

// Accuracy, drift and consistency of each system.
std::string SystemTiles(const std::vector<SystemSummary>& systems, const std::vector<SystemSummary>& baselines,
                        const std::string& gauge) {
  std::string html;
  for (std::size_t i = 0; i < systems.size(); ++i) {
    const SystemSummary& s = systems[i];
    html += "<h2 class=\"system\">" + Key(i) + Escape(DisplayName(s.system)) + "</h2>";
    html += Tiles(
        {{Fixed(100 * s.ate_m, 2) + " cm", "ATE: how far off, " + Percent(s.ate_share_of_path, 2) + " of the path",
          "position RMSE after Sim(3) alignment; of the live answers " + Fixed(100 * s.ate_live_m, 2) +
              " cm, constant pose " + Fixed(100 * baselines[0].ate_m, 1) + " cm, constant velocity " +
              Fixed(100 * baselines[1].ate_m, 1) + " cm"},
         {Fixed(100 * s.rpe_m, 2) + " cm/s, " + Fixed(kDegrees * s.rpe_rad, 2) + " °/s", "RPE: how fast it drifts",
          "over one second; constant pose " + Fixed(100 * baselines[0].rpe_m, 1) + " cm/s, " +
              Fixed(kDegrees * baselines[0].rpe_rad, 1) + " °/s; " + Percent(s.tracked_coverage) +
              " of the frames tracked (at least 10, and 40 % of the searched, features match at the first "
              "prediction), " +
              Percent(s.pose_coverage) + " with a pose"},
         {Readable(s.nees_pose_per_dof), "NEES of the pose: how consistent it is, 1 is ideal",
          "per degree of freedom, " + gauge + "; " + Readable(s.nees_pose_scale_free_per_dof) +
              " blind to scale, NIS " + Fixed(s.nis_per_dof, 2)}});
  }
  return html;
}

constexpr std::size_t kRows = 500;
constexpr std::size_t kErrorCells = 9;  // the other cells of a baseline are empty

std::vector<std::string> Cells(const std::string& name, const std::string& seed, const SystemSummary& s) {
  std::vector<std::string> cells = {name, seed};
  for (const double share : {s.ate_m, s.ate_live_m, s.ate_share_of_path, s.ate_se3_m})
    cells.push_back(Fixed(100 * share, 2));
  cells.insert(cells.end(), {Fixed(s.scale, 3), Fixed(100 * s.rpe_m, 2), Fixed(kDegrees * s.rpe_rad, 2)});
  for (const double coverage : {s.pose_coverage, s.tracked_coverage}) cells.push_back(Fixed(100 * coverage, 1));
  for (const double nees : {s.nees_pose_per_dof, s.nees_pose_scale_free_per_dof, s.nees_velocity_per_dof})
    cells.push_back(Readable(nees));
  cells.push_back(Fixed(s.nis_per_dof, 2));
  return cells;
}

}  // namespace

std::string RunSummary(const ResultData& data, const std::vector<RunMetrics>& judged) {
  const RunDescription& d = data.description;
  std::string systems;
  for (const std::string& system : data.Systems())
    systems += (systems.empty() ? "" : ", ") + Escape(DisplayName(system));
  const ev::Trajectory& first = data.runs.front().run.trajectory;
  const std::size_t frames = data.runs.front().run.frames.empty() ? first.size() : data.runs.front().run.frames.size();
  std::string html = "<p>" + systems + " on <b>" + Escape(d.input) + "</b>: " + Count(data.runs.size(), "run") +
                     " of " + Count(frames, "frame");
  if (!judged.empty()) {
    html += ", " + Fixed(judged[0].metrics.duration_s, 1) + " s and " + Fixed(judged[0].metrics.path_length_m, 2) +
            " m of path (the truth's, at the frames)";
  }
  html += ". Started " + Escape(d.started_utc) + ", took " + Fixed(d.seconds, 1) + " s.</p>\n";
  for (const std::string& warning : data.warnings) html += "<p class=\"warning\">" + Escape(warning) + "</p>\n";
  for (const std::string& note : d.notes) html += "<p class=\"warning\">" + Escape(note) + "</p>\n";
  if (judged.empty()) return html + "<p>There is no truth to judge by: paths, features and innovations only.</p>\n";

  const auto summaries = SummariseSystems(judged);
  const auto baselines = SummariseBaselines(judged);
  html += "<ul>";
  for (const std::string& verdict : d.verdicts) html += "<li><b>" + Escape(verdict) + "</b></li>";
  for (const SystemSummary& s : summaries) html += "<li>" + SystemSentence(s, baselines) + "</li>";
  for (std::size_t i = 1; i < summaries.size(); ++i) {
    const std::string pair = PairwiseSentence(judged, summaries[0], summaries[i]);
    if (!pair.empty()) html += "<li>" + pair + "</li>";
  }
  return html + "</ul>\n" + SystemTiles(summaries, baselines, Name(judged[0].metrics.options.gauge));
}

std::string RunTable(const std::vector<RunMetrics>& judged) {
  if (judged.empty()) return "";
  std::vector<std::vector<std::string>> rows = {{"system", "seed", "ATE [cm]", "live ATE [cm]", "of path [%]",
                                                 "ATE SE(3) [cm]", "scale", "RPE [cm/s]", "RPE [°/s]", "poses [%]",
                                                 "tracked [%]", "NEES / dof", "… scale-free", "… of velocity",
                                                 "NIS / dof", "ms / frame"}};
  for (const RunMetrics& run : judged) {
    if (rows.size() > kRows) break;
    rows.push_back(Cells(Escape(DisplayName(run.run.system)), std::to_string(run.run.seed), Summarise(run)));
    const std::optional<ev::Timing>& timing = run.metrics.timing;
    rows.back().push_back(timing ? Fixed(timing->ms_features + timing->ms_matching + timing->ms_filter, 1) : "–");
  }
  for (const SystemSummary& baseline : SummariseBaselines(judged)) {
    rows.push_back(Cells(baseline.system, "", baseline));
    rows.back().resize(kErrorCells);
    rows.back().resize(rows.front().size());
  }
  const std::string which = judged.size() > kRows ? "The first " + std::to_string(kRows) + " of " +
                                                        std::to_string(judged.size()) + " runs (metrics.json has all)"
                                                  : "Every run";
  return Table(which + ", and the baselines, medians over runs. Aligned by Sim(3) unless the column says otherwise.",
               rows);
}

std::string EventTable(const std::vector<RunMetrics>& judged) {
  std::vector<std::string> systems;  // in the order of the runs
  std::map<std::string, ev::EventSummary> sums;
  for (const RunMetrics& run : judged) {
    if (!run.metrics.events) continue;
    const auto [sum, fresh] = sums.try_emplace(run.run.system);
    if (fresh) systems.push_back(run.run.system);
    for (std::size_t i = 0; i < sum->second.size(); ++i) {
      sum->second[i].times += (*run.metrics.events)[i].times;
      sum->second[i].frames += (*run.metrics.events)[i].frames;
    }
  }
  if (systems.empty()) return "";
  std::vector<std::vector<std::string>> rows = {{"times (in frames)", "mode not reached", "landmark behind the camera",
                                                 "matrix not positive definite", "weight not finite"}};
  for (const std::string& system : systems) {
    rows.push_back({Escape(DisplayName(system))});
    for (const ev::EventCount& count : sums[system]) {
      rows.back().push_back(std::to_string(count.times) + " (" + std::to_string(count.frames) + ")");
    }
  }
  return Table(
      "Numerical events, which the filters' equations do not have: summed over particles, frames and runs. The first "
      "two are rare and harmless; the last two should be 0.",
      rows);
}

std::string VerdictTable(const std::vector<VerdictRow>& rows) {
  if (rows.empty()) return "";
  std::vector<std::vector<std::string>> cells = {{"system", "check", "value", "passes", "verdict", "false alarm"}};
  for (const auto& [system, check] : rows) {
    cells.push_back({Escape(DisplayName(system)), Escape(check.name), Readable(check.value),
                     Escape((check.at_least ? ">= " : "<= ") + Readable(check.threshold)),
                     check.pass ? "pass" : "<b>FAIL</b>", check.false_alarm > 0 ? Percent(check.false_alarm, 0) : "–"});
  }
  return Table("Each check, with the rate at which a consistent filter would fail it.", cells);
}

}  // namespace vobench::report
