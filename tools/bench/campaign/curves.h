// Dose-response curves: medians along a varied setting, and the breaking point, where half of the runs have broken.
// Source: tools/judge/evaluation/dose_response.h.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tools/bench/campaign/plan.h"
#include "tools/bench/campaign/results.h"
#include "tools/judge/evaluation/dose_response.h"

namespace vobench::campaign {

// One system. A lost run counts as worse than any number; failed tasks are no runs.
struct CurveLine {
  std::string system;
  std::vector<std::vector<evaluation::DoseRun>> runs;          // [metric]
  std::vector<std::vector<evaluation::DoseEstimate>> medians;  // [metric][dose]
  std::vector<evaluation::DoseEstimate> broken;                // share, [dose]
  std::vector<std::size_t> lost;                               // [dose]
  std::optional<evaluation::BreakingPoint> breaks;             // none without runs
};

struct Curve {
  CurveSpec spec;
  std::string group;                // the levels of `by`: "room, dusk"
  std::vector<std::string> levels;  // the doses as the file writes them
  std::vector<CurveLine> lines;     // one for each system
};

// In the order of the file; runs of one seed are one block.
std::vector<Curve> MakeCurves(const Campaign& campaign, const std::vector<TaskRecord>& records);

// curves.csv, a line for each number: docs/campaign.md has the columns.
std::string CurvesCsv(const std::vector<Curve>& curves);
// For tables.md.
std::string CurvesMarkdown(const std::vector<Curve>& curves);

// In the unit of the file: "12.5 ms"; "<= 1 ms" and "> 32 ms" (or >= and <, where smaller is harder) at the ends.
std::string DoseText(const Curve& curve, const evaluation::Crossing& crossing);
// Criterion of a broken run: "lost, or ATE above 0.05 m".
std::string BrokenMeans(const CurveSpec& spec);

}  // namespace vobench::campaign
