#include "tools/bench/campaign/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "tools/base/text.h"
#include "tools/bench/text.h"
#include "tools/judge/evaluation/statistics.h"

namespace vobench::campaign {
namespace {

// Index in `all`, to which a new one is appended.
std::size_t PlaceOf(const TextRow& one, std::vector<TextRow>& all, std::map<TextRow, std::size_t>& places) {
  const auto [at, is_new] = places.try_emplace(one, all.size());
  if (is_new) all.push_back(one);
  return at->second;
}

std::string Text(const Cell& cell, double unit, const std::string& lost) {
  if (cell.runs == 0) return cell.failed == 0 ? "-" : fmt::format("- ({} failed)", cell.failed);
  std::string text = NumberText(cell.median, unit, lost);
  if (cell.runs > 1 && !std::isnan(cell.median)) {
    text += fmt::format(" [{}, {}]", NumberText(cell.low, unit, lost), NumberText(cell.high, unit, lost));
  }
  if (cell.few_poses()) text += fmt::format(" @ {:.3g} %", 100 * cell.coverage);
  if (cell.failed > 0) text += fmt::format(" ({} failed)", cell.failed);
  return text;
}

std::string ValueOf(const ReferenceColumn& beside, const std::vector<std::string>& row, const std::string& lost) {
  const auto at = beside.values.find(row.front());
  if (at == beside.values.end()) return "-";
  return at->second == "X" ? lost : at->second;
}

std::string EscapeMarkdown(const std::string& text) { return Replaced(OneLine(text), {{'|', "\\|"}}); }

std::string EscapeLatex(const std::string& text) {
  return Replaced(OneLine(text), {{'\\', "\\textbackslash{}"},
                                  {'^', "\\textasciicircum{}"},
                                  {'~', "\\textasciitilde{}"},
                                  {'_', "\\_"},
                                  {'%', "\\%"},
                                  {'&', "\\&"},
                                  {'#', "\\#"},
                                  {'$', "\\$"},
                                  {'{', "\\{"},
                                  {'}', "\\}"}});
}

Table MakeTable(const Campaign& campaign, const TableSpec& spec, const std::vector<TaskRecord>& records) {
  const std::size_t metric = MetricIndex(spec.metric), coverage = MetricIndex("pose_coverage");
  const bool is_error =
      !LargerIsBetter(spec.metric) && (spec.metric.starts_with("ate") || spec.metric.starts_with("rpe"));
  Table table;
  table.spec = spec;
  std::map<std::pair<std::size_t, std::size_t>, std::vector<double>> values, coverages;
  std::map<std::pair<std::size_t, std::size_t>, Cell> cells;
  std::map<TextRow, std::size_t> rows, columns;
  for (const TaskRecord& record : records) {
    const TaskChoice choice = ChoiceOf(campaign, record.task);
    const std::pair at(PlaceOf(LevelsOf(campaign, spec.rows, choice), table.rows, rows),
                       PlaceOf(LevelsOf(campaign, spec.columns, choice), table.columns, columns));
    Cell& cell = cells[at];
    if (record.status == Status::failed) {
      ++cell.failed;
      continue;
    }
    ++cell.runs;
    const double value = ValueOf(record, metric);
    if (!std::isnan(value)) values[at].push_back(value);
    if (is_error && std::isfinite(value) && record.metric(coverage) &&
        !campaign.systems[choice.system].external.keyframes)
      coverages[at].push_back(*record.metric(coverage));
  }
  table.cells.assign(table.rows.size(), std::vector<Cell>(table.columns.size()));
  for (auto& [at, cell] : cells) {
    std::vector<double>& sorted = values[at];
    std::sort(sorted.begin(), sorted.end());
    cell.low = evaluation::Quantile(sorted, 0.25), cell.median = evaluation::Quantile(sorted, 0.5),
    cell.high = evaluation::Quantile(sorted, 0.75);
    cell.coverage = evaluation::Median(coverages[at]);
    table.cells[at.first][at.second] = cell;
  }
  return table;
}

}  // namespace

std::vector<Table> MakeTables(const Campaign& campaign, const TableSpec& spec, const std::vector<TaskRecord>& records) {
  if (!IsAligned(spec.metric)) return {MakeTable(campaign, spec, records)};
  const std::vector<evaluation::Alignment> alignments = AlignmentsOf(campaign);
  std::vector<Table> tables;
  for (const evaluation::Alignment alignment : alignments) {
    TableSpec one = spec;
    if (alignments.size() > 1) one.title += ", " + evaluation::Name(alignment);
    if (alignment != campaign.align) one.beside.clear();  // published numbers have the campaign's alignment
    tables.push_back(MakeTable(campaign, one, Aligned(campaign, records, alignment)));
    tables.back().alignment = alignment;
  }
  return tables;
}

std::string NumberText(double value, double unit, const std::string& lost) {
  if (std::isnan(value)) return "-";
  return std::isinf(value) ? lost : fmt::format("{:.3g}", value / unit);
}

std::vector<TextRow> Texts(const Table& table, const std::string& lost) {
  std::vector<TextRow> rows = {table.spec.rows};
  for (const auto& column : table.columns) rows[0].push_back(base::Join(column, ", "));
  for (const ReferenceColumn& beside : table.spec.beside) rows[0].push_back(beside.name);
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    TextRow& row = rows.emplace_back(table.rows[r]);
    for (const Cell& cell : table.cells[r]) row.push_back(Text(cell, table.spec.unit_in_si, lost));
    for (const ReferenceColumn& beside : table.spec.beside) row.push_back(ValueOf(beside, table.rows[r], lost));
  }
  return rows;
}

std::string Caption(const Table& table) {
  std::size_t least = std::numeric_limits<std::size_t>::max(), most = 0;
  bool few = false;
  for (const auto& row : table.cells) {
    for (const Cell& cell : row) least = std::min(least, cell.runs), most = std::max(most, cell.runs);
    few = few || std::ranges::any_of(row, &Cell::few_poses);
  }
  const std::string runs = least == most ? fmt::format("{}", most) : fmt::format("{} to {}", least, most);
  const bool is_relative = table.spec.metric.starts_with("rpe");  // not aligned, but in its scale
  const std::string how = table.alignment ? (is_relative ? "in the scale of alignment " : "after alignment ") +
                                                evaluation::Name(*table.alignment) + ", "
                                          : "";
  return fmt::format(
      "Median [quartiles] {}over {} runs a cell; X: no usable answer (how: below), worse than any number{}.", how, runs,
      few ? "; @: frames with a pose, where they are below 95 %" : "");
}

std::string MarkdownRows(const std::vector<TextRow>& rows, std::size_t left) {
  std::string text;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    text += "|";
    for (const std::string& cell : rows[r]) text += " " + EscapeMarkdown(cell) + " |";
    text += "\n";
    if (r > 0) continue;
    text += "|";
    for (std::size_t c = 0; c < rows[0].size(); ++c) text += c < left ? "---|" : "---:|";
    text += "\n";
  }
  return text;
}

std::string Markdown(const std::vector<Table>& tables) {
  std::string text;
  for (const Table& table : tables) {
    text += fmt::format("{}### {}\n\n{}\n\n{}", text.empty() ? "" : "\n", OneLine(table.spec.title), Caption(table),
                        MarkdownRows(Texts(table, "X"), table.spec.rows.size()));
  }
  return text;
}

std::string Latex(const std::vector<Table>& tables) {
  const std::string lost = "$\\times$";
  std::string text;
  for (const Table& table : tables) {
    std::vector<TextRow> rows = Texts(table, lost);
    const std::size_t left = table.spec.rows.size(), others = left + table.columns.size();
    text += fmt::format("% {}: {}\n\\begin{{tabular}}{{{}{}}}\n\\hline\n", OneLine(table.spec.title), Caption(table),
                        std::string(left, 'l'), std::string(rows[0].size() - left, 'r'));
    for (std::size_t r = 0; r < rows.size(); ++r) {
      for (std::size_t c = 0; c < rows[r].size(); ++c) {
        const bool is_number = r > 0 && c >= left && (c < others || rows[r][c] == lost);  // others: anything
        rows[r][c] = is_number ? Replaced(rows[r][c], {{'%', "\\%"}}) : EscapeLatex(rows[r][c]);
      }
      text += base::Join(rows[r], " & ") + " \\\\\n" + (r == 0 ? "\\hline\n" : "");
    }
    text += "\\hline\n\\end{tabular}\n";
  }
  return text;
}

std::vector<TextRow> EndRows(const Campaign& campaign, const std::vector<TaskRecord>& records) {
  struct Ends {
    std::vector<double> coverages;
    std::size_t count = 0;
    std::string reason;  // of the first
  };
  std::map<std::pair<std::size_t, Status>, Ends> all;
  bool any = false;
  for (const TaskRecord& record : records) {
    const std::size_t system = ChoiceOf(campaign, record.task).system;
    Ends& ends = all[{system, record.status}];
    if (ends.count++ == 0) ends.reason = record.reason;
    if (const auto share = record.metric(MetricIndex("pose_coverage"))) ends.coverages.push_back(100 * *share);
    any = any || record.status != Status::ok || campaign.systems[system].system.empty();
  }
  if (!any) return {};
  std::vector<TextRow> rows = {{"system", "runs", "ended", "frames with a pose", "the first: why"}};
  for (auto& [at, ends] : all) {
    const SystemEntry& system = campaign.systems[at.first];
    std::ranges::sort(ends.coverages);
    rows.push_back({Label(system.external, system.name), fmt::format("{}", ends.count), Name(at.second),
                    ends.coverages.empty() ? "-" : fmt::format("{:.3g} %", evaluation::Quantile(ends.coverages, 0.5)),
                    ends.reason.empty() ? "-" : ends.reason});
  }
  return rows;
}

}  // namespace vobench::campaign
