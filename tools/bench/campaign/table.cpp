#include "tools/bench/campaign/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "tools/base/text.h"
#include "tools/judge/evaluation/statistics.h"

namespace vobench::campaign {
namespace {

// Numbers each in the order in which they are first asked for.
class Numbered {
 public:
  explicit Numbered(std::vector<std::vector<std::string>>& all) : all_(all) {}
  std::size_t operator()(const std::vector<std::string>& one) {
    const auto [at, is_new] = numbers_.try_emplace(one, all_.size());
    if (is_new) all_.push_back(one);
    return at->second;
  }

 private:
  std::vector<std::vector<std::string>>& all_;
  std::map<std::vector<std::string>, std::size_t> numbers_;
};

std::string Number(double value, double unit, const std::string& lost) {
  if (std::isnan(value)) return "-";
  return std::isinf(value) ? lost : fmt::format("{:.3g}", value / unit);
}

std::string Text(const Cell& cell, double unit, const std::string& lost) {
  if (cell.runs == 0) return cell.failed == 0 ? "-" : fmt::format("- ({} failed)", cell.failed);
  std::string text = Number(cell.median, unit, lost);
  if (cell.runs > 1 && !std::isnan(cell.median)) {
    text += fmt::format(" [{}, {}]", Number(cell.low, unit, lost), Number(cell.high, unit, lost));
  }
  if (cell.failed > 0) text += fmt::format(" ({} failed)", cell.failed);
  return text;
}

std::string ValueOf(const ReferenceColumn& beside, const std::vector<std::string>& row, const std::string& lost) {
  const auto at = beside.values.find(row.front());
  if (at == beside.values.end()) return "-";
  return at->second == "X" ? lost : at->second;
}

std::string EscapeLatex(const std::string& text) {
  std::string out;
  for (const char c : OneLine(text)) {
    if (c == '\\') {
      out += "\\textbackslash{}";
    } else if (c == '^') {
      out += "\\textasciicircum{}";
    } else if (c == '~') {
      out += "\\textasciitilde{}";
    } else {
      if (std::string("_%&#${}").find(c) != std::string::npos) out += '\\';
      out += c;
    }
  }
  return out;
}

}  // namespace

Table MakeTable(const Campaign& campaign, const TableSpec& spec, const std::vector<TaskRecord>& records) {
  const std::size_t metric = MetricIndex(spec.metric);
  Table table;
  table.spec = spec;
  std::map<std::pair<std::size_t, std::size_t>, std::vector<double>> values;
  std::map<std::pair<std::size_t, std::size_t>, Cell> cells;
  Numbered row(table.rows), column(table.columns);
  for (const TaskRecord& record : records) {
    const TaskChoice choice = ChoiceOf(campaign, record.task);
    const std::pair at(row(LevelsOf(campaign, spec.rows, choice)), column(LevelsOf(campaign, spec.columns, choice)));
    Cell& cell = cells[at];
    if (record.status == Status::failed) {
      ++cell.failed;
      continue;
    }
    ++cell.runs;
    cell.lost += record.status != Status::ok;
    if (const double value = ValueOf(record, metric); !std::isnan(value)) values[at].push_back(value);
  }
  table.cells.assign(table.rows.size(), std::vector<Cell>(table.columns.size()));
  for (auto& [at, cell] : cells) {
    std::vector<double>& sorted = values[at];
    std::sort(sorted.begin(), sorted.end());
    cell.low = evaluation::Quantile(sorted, 0.25), cell.median = evaluation::Quantile(sorted, 0.5),
    cell.high = evaluation::Quantile(sorted, 0.75);
    table.cells[at.first][at.second] = cell;
  }
  return table;
}

std::vector<std::string> ColumnNames(const Table& table) {
  std::vector<std::string> names;
  for (const auto& column : table.columns) names.push_back(base::Join(column, ", "));
  for (const ReferenceColumn& beside : table.spec.beside) names.push_back(beside.name);
  return names;
}

std::vector<std::string> RowTexts(const Table& table, std::size_t row, const std::string& lost) {
  std::vector<std::string> texts;
  for (const Cell& cell : table.cells[row]) texts.push_back(Text(cell, table.spec.unit_in_si, lost));
  for (const ReferenceColumn& beside : table.spec.beside) texts.push_back(ValueOf(beside, table.rows[row], lost));
  return texts;
}

std::string Caption(const Table& table) {
  std::size_t least = std::numeric_limits<std::size_t>::max(), most = 0;
  for (const auto& row : table.cells) {
    for (const Cell& cell : row) least = std::min(least, cell.runs), most = std::max(most, cell.runs);
  }
  const std::string runs = least == most ? fmt::format("{}", most) : fmt::format("{} to {}", least, most);
  return fmt::format("Median [quartiles] over {} runs a cell; X: lost, which counts as worse than any number.", runs);
}

std::string EscapeMarkdown(const std::string& text) {
  std::string out;
  for (const char c : OneLine(text)) {
    if (c == '|') out += '\\';
    out += c;
  }
  return out;
}

std::string Markdown(const std::vector<Table>& tables) {
  std::string text;
  for (const Table& table : tables) {
    text += fmt::format("{}### {}\n\n{}\n\n|", text.empty() ? "" : "\n", OneLine(table.spec.title), Caption(table));
    for (const std::string& name : table.spec.rows) text += " " + EscapeMarkdown(name) + " |";
    for (const std::string& name : ColumnNames(table)) text += " " + EscapeMarkdown(name) + " |";
    text += "\n|";
    for (std::size_t i = 0; i < table.spec.rows.size(); ++i) text += "---|";
    for (std::size_t i = 0; i < table.columns.size() + table.spec.beside.size(); ++i) text += "---:|";
    for (std::size_t r = 0; r < table.rows.size(); ++r) {
      text += "\n|";
      for (const std::string& level : table.rows[r]) text += " " + EscapeMarkdown(level) + " |";
      for (const std::string& cell : RowTexts(table, r, "X")) text += " " + EscapeMarkdown(cell) + " |";
    }
    text += "\n";
  }
  return text;
}

std::string Latex(const std::vector<Table>& tables) {
  std::string text;
  for (const Table& table : tables) {
    text += fmt::format("% {}: {}\n\\begin{{tabular}}{{{}{}}}\n\\hline\n", OneLine(table.spec.title), Caption(table),
                        std::string(table.spec.rows.size(), 'l'),
                        std::string(table.columns.size() + table.spec.beside.size(), 'r'));
    std::vector<std::string> line;
    for (const std::string& name : table.spec.rows) line.push_back(EscapeLatex(name));
    for (const std::string& name : ColumnNames(table)) line.push_back(EscapeLatex(name));
    text += base::Join(line, " & ") + " \\\\\n\\hline\n";
    for (std::size_t r = 0; r < table.rows.size(); ++r) {
      line.clear();
      for (const std::string& level : table.rows[r]) line.push_back(EscapeLatex(level));
      const std::string lost = "$\\times$";
      const std::vector<std::string> texts = RowTexts(table, r, lost);
      for (std::size_t c = 0; c < texts.size(); ++c) {
        const bool ours = c < table.columns.size();  // those of others may have anything in them
        line.push_back(ours || texts[c] == lost ? texts[c] : EscapeLatex(texts[c]));
      }
      text += base::Join(line, " & ") + " \\\\\n";
    }
    text += "\\hline\n\\end{tabular}\n";
  }
  return text;
}

}  // namespace vobench::campaign
