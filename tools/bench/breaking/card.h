// Card of a system: accuracy, drift, consistency, breaking points beside those of other systems, time and memory.
// Source: docs/bench.md.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/bench/breaking/bench_file.h"
#include "tools/bench/breaking/bisection.h"

namespace vobench::breaking {

// Medians over runs that are not lost; none if all are lost.
struct AccuracyResult {
  std::string scenario;
  int runs = 0, lost = 0;
  std::optional<double> ate_share_of_path, drift, nees, nis;
};

struct StressResult : Scale {
  std::vector<StepRuns> done;
  std::optional<Breaking> breaking;
};

// Costs that vary from run to run: medians over runs.
struct Cost {
  double tracking_s = 0, memory_mb = 0;
};

struct Card {
  std::string system, mode;  // "quick" or "full"
  int steps = 0, seeds = 0;
  std::vector<AccuracyResult> accuracy;  // the last over all scenarios
  std::vector<std::string> left_out;     // accuracy without the recordings' paths
  std::vector<StressResult> stresses;
  std::optional<Cost> cost;
};

// "12 ms [10 ms to 15 ms]", "broken at 1 ms, the mildest", "not broken at 33 ms, its limit: the frame interval".
std::string BreakingText(const StressResult& stress);

// Reading throws std::invalid_argument for invalid text.
std::string ToJson(const Card& card);
Card CardFromJson(const std::string& text);

// One picture: the first card is the system's, the others stand beside it. The picture and all numbers as tables, in a
// page that loads nothing. The breaking points, for terminals.
std::string CardSvg(const std::vector<Card>& cards);
std::string CardHtml(const std::vector<Card>& cards);
std::string CardText(const Card& card);

}  // namespace vobench::breaking
