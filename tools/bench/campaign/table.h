// Tables over results: medians and quartiles by what was varied, as Markdown and LaTeX.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tools/bench/campaign/plan.h"
#include "tools/bench/campaign/results.h"

namespace vobench::campaign {

// One cell: quartiles over runs, a lost one counted as worse than any number.
struct Cell {
  std::size_t runs = 0, lost = 0, failed = 0;  // runs: all but the failed
  double low = 0, median = 0, high = 0;        // infinite where it falls on a lost run; NaN without runs
};

struct Table {
  TableSpec spec;
  std::vector<std::vector<std::string>> rows, columns;  // the levels of each, in the order of the campaign
  std::vector<std::vector<Cell>> cells;                 // [row][column]
};

Table MakeTable(const Campaign& campaign, const TableSpec& spec, const std::vector<TaskRecord>& records);

// Behind those of the rows: ours, and those of others beside them.
std::vector<std::string> ColumnNames(const Table& table);
// What a row has in these: "0.0123 [0.0101, 0.0150]", `lost` for what falls on a lost run, "-" without runs.
std::vector<std::string> RowTexts(const Table& table, std::size_t row, const std::string& lost);
// What a cell is, and over how many runs.
std::string Caption(const Table& table);

// As it may stand in a cell of Markdown's.
std::string EscapeMarkdown(const std::string& text);

// All tables of the campaign: "0.0123 [0.0101, 0.0150]", X for lost.
std::string Markdown(const std::vector<Table>& tables);
std::string Latex(const std::vector<Table>& tables);

}  // namespace vobench::campaign
