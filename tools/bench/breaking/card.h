// Card of a system: accuracy, drift, consistency, breaking points beside those of other systems, time and memory.
// Source: docs/bench.md.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/bench/breaking/bench_file.h"
#include "tools/bench/breaking/bisection.h"

namespace vobench::breaking {

struct AccuracyResult {
  std::string scenario;
  int runs = 0, lost = 0;
  // Medians over runs that are not lost; none without.
  std::optional<double> ate_share_of_path, drift, nees, nis;
};

struct StressResult {
  std::string name, unit, limit;
  double mild = 0, severe = 1;
  bool logarithmic = false;
  std::vector<StepRuns> done;
  std::optional<Breaking> breaking;
};

// What differs from run to run.
struct Cost {
  double seconds = 0;  // of a run's tracking, median
  double memory_mb = 0;
};

struct Card {
  std::string system, mode;  // "quick" or "full"
  int steps = 0, seeds = 0;
  std::vector<AccuracyResult> accuracy;
  std::vector<std::string> left_out;  // accuracy without the recordings' paths
  std::vector<StressResult> stresses;
  std::optional<Cost> cost;
};

// The value at a share of the way, and the breaking point in words: "12 ms [10 to 15 ms]", "broken at 1 ms, the mildest", "not broken
// at 33 ms (read-out = frame interval)".
std::string Text(const StressResult& stress, double share);
std::string BreakingText(const StressResult& stress);

// With `cost` where there is one. Reading throws std::invalid_argument where it is no card.
std::string ToJson(const Card& card);
Card CardFromJson(const std::string& text);

// One picture: the first card is the system's, the others stand beside it.
std::string CardSvg(const std::vector<Card>& cards);
// The picture and all numbers as tables; loads nothing.
std::string CardHtml(const std::vector<Card>& cards);
// For terminals.
std::string CardText(const Card& card);

}  // namespace vobench::breaking
