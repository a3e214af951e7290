#include "tools/bench/report/tables.h"

#include <cmath>
#include <map>

#include "tools/bench/report/html.h"
#include "tools/bench/result/system_summary.h"
#include "tools/bench/text.h"

namespace vobench::report {
namespace {

namespace ev = evaluation;

constexpr double kDegrees = 180 / M_PI;
constexpr std::size_t kRows = 500;

std::vector<std::string> ErrorCells(const SystemSummary& s) {
  return {Fixed(100 * s.ate_m, 2), Fixed(100 * s.ate_share_of_path, 2), Fixed(100 * s.ate_se3_m, 2), Fixed(s.scale, 3),
          Fixed(100 * s.rpe_m, 2), Fixed(kDegrees * s.rpe_rad, 2)};
}

}  // namespace

std::string RunTable(const std::vector<RunMetrics>& judged) {
  if (judged.empty()) return "";
  std::vector<std::vector<std::string>> rows = {{"system", "seed", "ATE [cm]", "of path [%]", "ATE SE(3) [cm]", "scale",
                                                 "RPE [cm/s]", "RPE [°/s]", "poses [%]", "tracked [%]", "NEES / dof",
                                                 "… scale-free", "… of velocity", "NIS / dof", "ms / frame"}};
  const double nan = std::nan("");
  for (const RunMetrics& run : judged) {
    if (rows.size() > kRows) break;
    const ev::Metrics& m = run.metrics;
    std::vector<std::string> cells = {Escape(DisplayName(run.run.system)), std::to_string(run.run.seed)};
    for (std::string& cell : ErrorCells(SummariseErrors(run))) cells.push_back(std::move(cell));
    const auto nees = [&](const std::optional<ev::NeesSummary>& n) {
      return Readable(n && n->frames > 0 ? n->mean / n->dof : nan);
    };
    const bool consistency = m.consistency.has_value();
    cells.push_back(Fixed(m.coverage ? 100 * m.coverage->pose_coverage() : nan, 1));
    cells.push_back(Fixed(m.coverage ? 100 * m.coverage->tracked_coverage().value_or(nan) : nan, 1));
    cells.push_back(consistency ? nees(m.consistency->pose) : "–");
    cells.push_back(consistency ? nees(m.consistency->pose_scale_free) : "–");
    cells.push_back(consistency ? nees(m.consistency->velocity) : "–");
    cells.push_back(Fixed(m.nis && m.nis->frames > 0 ? m.nis->mean_per_dof : nan, 2));
    cells.push_back(m.timing ? Fixed(m.timing->ms_features + m.timing->ms_matching + m.timing->ms_filter, 1) : "–");
    rows.push_back(std::move(cells));
  }
  for (const SystemSummary& baseline : SummariseBaselines(judged)) {
    std::vector<std::string> cells = {baseline.system, ""};
    for (std::string& cell : ErrorCells(baseline)) cells.push_back(std::move(cell));
    cells.resize(rows.front().size());
    rows.push_back(std::move(cells));
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
