#include "tools/bench/campaign/curves.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "tools/bench/campaign/table.h"

namespace vobench::campaign {
namespace {

using evaluation::Crossing;
using evaluation::DoseEstimate;
using evaluation::DoseRun;

CurveLine MakeLine(const CurveSpec& spec, const std::string& system,
                   const std::vector<std::pair<const TaskRecord*, DoseRun>>& runs) {
  CurveLine line;
  line.system = system;
  line.lost.resize(spec.doses.size());
  for (const std::string& metric : spec.metrics) {
    std::vector<DoseRun>& values = line.runs.emplace_back();
    for (auto [record, run] : runs) {
      run.value = ValueOf(*record, MetricIndex(metric));
      values.push_back(run);
    }
    line.medians.push_back(evaluation::MediansByDose(spec.doses.size(), values));
  }
  std::vector<DoseRun> broken;
  for (auto [record, run] : runs) {
    const bool lost = record->status != Status::ok;
    line.lost[run.dose] += lost;
    const double error = ValueOf(*record, MetricIndex("ate_m"));
    run.value = lost || (spec.break_error_m > 0 && !(error <= spec.break_error_m));
    broken.push_back(run);
  }
  line.broken = evaluation::MeansByDose(spec.doses.size(), broken);
  line.breaks = evaluation::FindBreakingPoint(spec.doses, broken);
  return line;
}

// `alignment`: what the groups are named by, too.
void MakeCurvesOf(const Campaign& campaign, const CurveSpec& spec, const std::vector<TaskRecord>& records,
                  const std::string& alignment, std::vector<Curve>& curves) {
  const auto along = static_cast<std::size_t>(std::ranges::find(campaign.factors, spec.along, &Factor::name) -
                                              campaign.factors.begin());
  // By group in the order of the tasks, then by system.
  std::vector<std::string> groups;
  std::map<std::string, std::size_t> numbers;
  std::vector<std::vector<std::vector<std::pair<const TaskRecord*, DoseRun>>>> runs;
  for (const TaskRecord& record : records) {
    const TaskChoice choice = ChoiceOf(campaign, record.task);
    std::vector<std::string> levels = LevelsOf(campaign, spec.by, choice);
    if (!alignment.empty()) levels.push_back(alignment);
    const std::string group = fmt::format("{}", fmt::join(levels, ", "));
    const auto [at, is_new] = numbers.try_emplace(group, groups.size());
    const std::size_t g = at->second;
    if (is_new) {
      groups.push_back(group);
      runs.emplace_back(campaign.systems.size());
    }
    if (record.status != Status::failed) {
      runs[g][choice.system].push_back({&record, {choice.levels[along], choice.seed, 0}});
    }
  }
  for (std::size_t g = 0; g < groups.size(); ++g) {
    Curve& curve = curves.emplace_back();
    curve.spec = spec;
    curve.group = groups[g];
    for (const Level& level : campaign.factors[along].levels) curve.levels.push_back(level.name);
    for (std::size_t s = 0; s < campaign.systems.size(); ++s) {
      curve.lines.push_back(MakeLine(spec, campaign.systems[s].name, runs[g][s]));
    }
  }
}

// Empty for NaN; inf (or -inf) of lost runs.
std::string Field(double value) { return std::isnan(value) ? "" : fmt::format("{}", value); }

std::string EndField(const Crossing& crossing) {
  return crossing.kind == Crossing::Kind::inside ? Field(crossing.dose) : "";
}

constexpr const char* kKinds[] = {"at_the_first", "inside", "not_reached"};  // by Crossing::Kind

std::string CellText(const DoseEstimate& estimate) {
  if (estimate.runs == 0) return "-";
  return fmt::format("{} [{}, {}]", NumberText(estimate.value, 1, "X"), NumberText(estimate.low, 1, "X"),
                     NumberText(estimate.high, 1, "X"));
}

std::string TitleOf(const Curve& curve, const std::string& what) {
  return fmt::format("{} along {}{}", what, curve.spec.along, curve.group.empty() ? "" : ", " + curve.group);
}

}  // namespace

std::vector<Curve> MakeCurves(const Campaign& campaign, const std::vector<TaskRecord>& records) {
  std::vector<Curve> curves;
  const std::vector<evaluation::Alignment> alignments = AlignmentsOf(campaign);
  for (const CurveSpec& spec : campaign.curves) {
    for (const evaluation::Alignment alignment : alignments)  // none has lines of two
      MakeCurvesOf(campaign, spec, Aligned(campaign, records, alignment),
                   alignments.size() > 1 ? evaluation::Name(alignment) : "", curves);
  }
  return curves;
}

std::string CurvesCsv(const std::vector<Curve>& curves) {
  std::string csv = "curve,along,group,system,dose,level,quantity,runs,lost,value,low,high,state\n";
  for (std::size_t c = 0; c < curves.size(); ++c) {
    const Curve& curve = curves[c];
    for (const CurveLine& line : curve.lines) {
      const std::string start =
          fmt::format("{},{},{},{},", c + 1, CsvField(curve.spec.along), CsvField(curve.group), CsvField(line.system));
      const auto add = [&](const std::string& quantity, const std::vector<DoseEstimate>& estimates) {
        for (std::size_t d = 0; d < estimates.size(); ++d) {
          const DoseEstimate& e = estimates[d];
          csv +=
              fmt::format("{}{},{},{},{},{},{},{},{},\n", start, Field(curve.spec.doses[d]), CsvField(curve.levels[d]),
                          quantity, e.runs, line.lost[d], Field(e.value), Field(e.low), Field(e.high));
        }
      };
      for (std::size_t m = 0; m < curve.spec.metrics.size(); ++m) add(curve.spec.metrics[m], line.medians[m]);
      add("broken_share", line.broken);
      if (!line.breaks) continue;
      csv += fmt::format("{},,breaking_point,,,{},{},{},{}\n", start, EndField(line.breaks->at),
                         EndField(line.breaks->low), EndField(line.breaks->high),
                         kKinds[static_cast<std::size_t>(line.breaks->at.kind)]);
    }
  }
  return csv;
}

std::string CurvesMarkdown(const std::vector<Curve>& curves) {
  std::string text;
  for (const Curve& curve : curves) {
    const auto table = [&](const std::string& title, const std::string& caption, const auto& estimates) {
      std::vector<TextRow> rows = {{curve.spec.along}};
      for (const CurveLine& line : curve.lines) rows[0].push_back(line.system);
      for (std::size_t d = 0; d < curve.levels.size(); ++d) {
        TextRow& row = rows.emplace_back(TextRow{curve.levels[d]});
        for (const CurveLine& line : curve.lines) row.push_back(CellText(estimates(line)[d]));
      }
      text += fmt::format("\n### {}\n\n{}\n\n{}", OneLine(TitleOf(curve, title)), caption, MarkdownRows(rows, 1));
    };
    for (std::size_t m = 0; m < curve.spec.metrics.size(); ++m) {
      table(
          curve.spec.metrics[m],
          "Median over runs [95 % bootstrap interval]; X: lost.", [m](const CurveLine& line) -> const auto& {
            return line.medians[m];
          });
    }
    table(
        "Share of runs broken", fmt::format("Broken: {}. [95 % bootstrap interval]", BrokenMeans(curve.spec)),
        [](const CurveLine& line) -> const auto& { return line.broken; });
    text += "\nHalf of the runs have broken at";
    for (const CurveLine& line : curve.lines) {
      text += (&line == &curve.lines.front() ? " " : "; ") + OneLine(line.system) + ": ";
      text += line.breaks ? fmt::format("{} [{}, {}]", DoseText(curve, line.breaks->at),
                                        DoseText(curve, line.breaks->low), DoseText(curve, line.breaks->high))
                          : "-";
    }
    text += "\n";
  }
  return text;
}

std::string DoseText(const Curve& curve, const Crossing& crossing) {
  const CurveSpec& spec = curve.spec;
  const bool rises = spec.doses.back() > spec.doses.front();
  if (crossing.kind == Crossing::Kind::at_the_first) return (rises ? "<= " : ">= ") + curve.levels.front();
  if (crossing.kind == Crossing::Kind::not_reached) return (rises ? "> " : "< ") + curve.levels.back();
  return fmt::format("{:.3g}{}{}", crossing.dose / spec.unit_in_si, spec.unit.empty() ? "" : " ", spec.unit);
}

std::string BrokenMeans(const CurveSpec& spec) {
  return spec.break_error_m > 0 ? fmt::format("lost, or ATE above {:.3g} m", spec.break_error_m) : "lost";
}

}  // namespace vobench::campaign
