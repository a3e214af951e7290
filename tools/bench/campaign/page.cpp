#include "tools/bench/campaign/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "tools/base/text.h"
#include "tools/bench/campaign/table.h"
#include "tools/bench/provenance.h"
#include "tools/bench/report/html.h"
#include "tools/bench/text.h"
#include "tools/judge/evaluation/statistics.h"

namespace vobench::campaign {

std::string NumberOrLost(double value) { return std::isinf(value) ? "lost" : Readable(value); }

namespace {

constexpr std::size_t kRows = 500;

std::vector<TextRow> Escaped(std::vector<TextRow> rows) {
  for (TextRow& row : rows) {
    for (std::string& cell : row) cell = Escape(cell);
  }
  return rows;
}

// Median over all answered tasks of a system, a lost one worse than any number.
double MedianOf(const std::vector<TaskRecord>& records, const std::string& system, const std::string& metric) {
  const std::size_t index = MetricIndex(metric);
  std::vector<double> values;
  for (const TaskRecord& record : records) {
    const double value = record.system == system ? ValueOf(record, index) : std::nan("");
    if (!std::isnan(value)) values.push_back(value);
  }
  return evaluation::Median(values);
}

std::string What(const Campaign& campaign, const std::vector<TaskRecord>& records) {
  std::string text = Count(campaign.scenarios.size(), "scenario");
  for (const Factor& factor : campaign.factors) {
    text += fmt::format(" × {} {}", factor.levels.size(), Escape(factor.name));
  }
  text += fmt::format(" × {} × {} = <b>{} tasks</b>: ", Count(campaign.systems.size(), "system"),
                      Count(campaign.seeds.size(), "seed"), records.size());
  std::map<std::string, std::size_t> counts;
  for (const TaskRecord& record : records) ++counts[Name(record.status)];
  std::vector<std::string> parts;
  for (const auto& [status, count] : counts) parts.push_back(fmt::format("{} {}", count, status));
  return "<p>" + text + base::Join(parts, ", ") + ".</p>\n";
}

// Breaking point of each system, in a sentence for each curve.
std::string Verdicts(const std::vector<Curve>& curves) {
  std::string html;
  for (const Curve& curve : curves) {
    std::string sentence;
    for (const CurveLine& line : curve.lines) {
      if (!line.breaks) continue;
      const bool unbroken = line.breaks->at.kind == evaluation::Crossing::Kind::not_reached;
      sentence += sentence.empty() ? "" : "; ";
      sentence += "<b>" + Escape(line.system) + "</b> ";
      sentence += unbroken ? "bears all of it (" + Escape(DoseText(curve, line.breaks->at)) + ")"
                           : "breaks at <b>" + Escape(DoseText(curve, line.breaks->at)) + "</b> [" +
                                 Escape(DoseText(curve, line.breaks->low)) + ", " +
                                 Escape(DoseText(curve, line.breaks->high)) + "]";
    }
    if (sentence.empty()) continue;
    html += "<li>" + Escape(curve.spec.along + (curve.group.empty() ? "" : ", " + curve.group)) + ": " + sentence +
            ".</li>\n";
  }
  return html.empty() ? "" : "<p>Half of the runs are broken at (95 % intervals):</p><ul>" + html + "</ul>\n";
}

std::string SystemTiles(const Campaign& campaign, const std::vector<TaskRecord>& records) {
  std::string html;
  for (std::size_t s = 0; s < campaign.systems.size(); ++s) {
    const std::string& system = campaign.systems[s].name;
    const bool ours = !campaign.systems[s].system.empty();
    std::size_t runs = 0, lost = 0;
    std::string ends;  // of those without an answer: "crashed, timed out"
    for (const TaskRecord& record : records) {
      if (record.system != system || record.status == Status::failed) continue;
      ++runs;
      lost += record.status != Status::ok;
      const std::string end = Replaced(Name(record.status), {{'_', " "}});
      if (record.status != Status::ok && ends.find(end) == std::string::npos) ends += (ends.empty() ? "" : ", ") + end;
    }
    const double nees = MedianOf(records, system, "nees_pose_per_dof"), ate = MedianOf(records, system, "ate_m"),
                 coverage = MedianOf(records, system, "pose_coverage");
    const std::string of_few = coverage < kFewPoses ? fmt::format(" @ {:.0f} % of the frames", 100 * coverage) : "";
    const std::string how = evaluation::Name(AlignmentOf(campaign, campaign.systems[s]));
    html += "<h2 class=\"system\">" + report::Key(s) + Escape(Label(campaign.systems[s].external, system)) + "</h2>" +
            report::Tiles(
                {{std::isinf(ate) ? ends : Fixed(100 * ate, 2) + " cm" + of_few, "ATE, median of all tasks",
                  "position RMSE after alignment " + how + "; a lost run counts as worse than any number"},
                 {fmt::format("{} of {}", lost, runs), "runs " + (lost == 0 ? "lost" : ends),
                  "crashed, timed out, no answer: as the program ended; lost: by the campaign's limits of coverage and "
                  "error; tasks that failed are not counted"},
                 {ours ? NumberOrLost(nees) : "–", "NEES of the pose, median of all tasks; 1 is ideal",
                  ours ? "time mean per degree of freedom, not aligned" : "without a covariance"}});
  }
  return html;
}

std::string TaskTable(const Campaign& campaign, const std::vector<TaskRecord>& records) {
  const std::vector<std::string> varied = VariedNames(campaign);
  const std::vector<std::string> shown = {
      "ate_m", "ate_live_m", "rpe_m", "pose_coverage", "tracked_coverage", "nees_pose_per_dof", "nis_per_dof"};
  TextRow head = varied;
  head.insert(head.begin(), "task");
  head.insert(head.end(), {"system", "seed", "status", "alignment"});
  head.insert(head.end(), shown.begin(), shown.end());
  std::vector<TextRow> rows = {head};
  for (std::size_t i = 0; i < std::min(kRows, records.size()); ++i) {
    const TaskRecord& record = records[i];
    const TaskChoice choice = ChoiceOf(campaign, record.task);
    TextRow& row = rows.emplace_back(LevelsOf(campaign, varied, choice));
    row.insert(row.begin(), std::to_string(record.task));
    row.insert(row.end(), {record.system, std::to_string(record.seed), Name(record.status),
                           evaluation::Name(AlignmentOf(campaign, campaign.systems[choice.system]))});
    for (const std::string& metric : shown) {
      const std::optional<double> value = record.metric(MetricIndex(metric));
      row.push_back(value ? base::Significant(*value, 3) : "–");
    }
  }
  const std::string which =
      records.size() > kRows ? fmt::format("The first {} of {} tasks", kRows, records.size()) : "Every task";
  return report::Table(which + "; results.csv has all, with more columns.", Escaped(rows));
}

std::string Record(const Campaign& campaign) {
  std::string html = "<p>Versions</p><pre>";
  for (const auto& [name, version] : Versions()) html += Escape(name + " " + version) + "\n";
  return html + "</pre><details><summary>The campaign, resolved</summary><pre>" + Escape(campaign.resolved) +
         "</pre></details>";
}

}  // namespace

std::string CampaignPage(const Campaign& campaign, const Merged& merged) {
  report::Page page;
  page.title = campaign.name;
  page.summary = What(campaign, merged.records) + Verdicts(merged.curves) + SystemTiles(campaign, merged.records);
  for (const SystemEntry& system : campaign.systems) page.systems.push_back(system.name);
  for (const Curve& curve : merged.curves) {
    page.sections.push_back(
        {"Along " + curve.spec.along + (curve.group.empty() ? "" : ": " + curve.group),
         "Lines: medians over runs. Bands: 95 % bootstrap intervals. Small dots: runs, on the edge of the frame lost "
         "ones. Large dot: half of the runs have broken, with its interval as a bar.",
         CurveFigures(curve)});
  }
  std::string tables;
  for (const Table& table : merged.tables) {
    tables += "<h3>" + Escape(table.spec.title) + "</h3>" + report::Table(Caption(table), Escaped(Texts(table, "X")));
  }
  page.sections.push_back({"Tables", "", {}, tables});
  if (const std::vector<TextRow> ends = EndRows(campaign, merged.records); !ends.empty())
    page.sections.push_back({"How the runs ended", "", {}, report::Table("By system", Escaped(ends))});
  page.sections.push_back({"Tasks", "", {}, TaskTable(campaign, merged.records)});
  page.sections.push_back({"How this was made", "", {}, Record(campaign)});
  return report::Html(page);
}

}  // namespace vobench::campaign
