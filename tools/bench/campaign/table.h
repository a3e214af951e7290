// Tables over results: medians and quartiles by what was varied, as Markdown and LaTeX.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "tools/bench/campaign/plan.h"
#include "tools/bench/campaign/results.h"

namespace vobench::campaign {

// Pose coverage below which an error has it beside it.
constexpr double kFewPoses = 0.95;

// One cell: quartiles over runs, a lost one counted as worse than any number.
struct Cell {
  std::size_t runs = 0, failed = 0;      // runs: all but the failed
  double low = 0, median = 0, high = 0;  // infinite where it falls on a lost run; NaN without runs
  // Median pose coverage behind an error, of systems that write all frames; NaN where there is none.
  double coverage = std::numeric_limits<double>::quiet_NaN();
  bool few_poses() const { return coverage < kFewPoses && std::isfinite(median); }  // shown beside the number
};

struct Table {
  TableSpec spec;
  std::optional<evaluation::Alignment> alignment;       // of all its numbers, where they depend on one
  std::vector<std::vector<std::string>> rows, columns;  // the levels of each, in the order of the campaign
  std::vector<std::vector<Cell>> cells;                 // [row][column]
};

// One table; or, where its numbers have several alignments, one for each.
std::vector<Table> MakeTables(const Campaign& campaign, const TableSpec& spec, const std::vector<TaskRecord>& records);

// Head and rows as texts: the levels of the row, then our numbers, "0.0123 [0.0101, 0.0150] @ 50 %", and those of
// others. `lost`: text for values that fall on a lost run, "-" for no runs.
using TextRow = std::vector<std::string>;
std::vector<TextRow> Texts(const Table& table, const std::string& lost);
// Caption: quantity of a cell, alignment, and number of runs.
std::string Caption(const Table& table);
// "-" for NaN, `lost` for infinity.
std::string NumberText(double value, double unit, const std::string& lost);

// Markdown of the rows, the first of them the head: `left` columns aligned to the left, the others to the right.
std::string MarkdownRows(const std::vector<TextRow>& rows, std::size_t left);
// All tables of the campaign.
std::string Markdown(const std::vector<Table>& tables);
std::string Latex(const std::vector<Table>& tables);
// Number of runs of each system by outcome, with pose coverage and the first reason: head and rows; empty where all
// are ours and ok.
std::vector<TextRow> EndRows(const Campaign& campaign, const std::vector<TaskRecord>& records);

}  // namespace vobench::campaign
