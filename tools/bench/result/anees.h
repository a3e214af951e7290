// Average NEES (ANEES) of a system over Monte-Carlo runs, by block of the state: table for a terminal, anees.csv.
// Source: docs/metrics.md, NEES; docs/point_world.md.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/judge/evaluation/cramer_rao.h"
#include "tools/judge/evaluation/mixture_scores.h"
#include "tools/judge/evaluation/summary.h"

namespace vobench {

// All runs of one system.
struct SystemRuns {
  std::string system;
  std::vector<evaluation::Metrics> metrics;
  std::vector<std::vector<evaluation::BlockNees>> nees;  // [run][frame]
  // RMSE / Cramer-Rao bound over all frames and runs, of the first four of kStateBlocks; where requested.
  std::optional<evaluation::BoundRatio> bound;
};

// Per system, for a terminal: ATE by alignment, and ANEES per degree of freedom by block, with the band of the average
// of as many consistent runs at one frame (95 %). The first frame, whose pose is given, is left out.
std::string AneesTable(const std::vector<SystemRuns>& systems);

// anees.csv, the same frame by frame: system,block,dof,frame,runs,anees_per_dof,low,high.
std::string AneesCsv(const std::vector<SystemRuns>& systems);

}  // namespace vobench
