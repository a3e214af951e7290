// Reader of bench.yaml, strict: accuracy, stresses and what `--attack` may change.
// Source: docs/bench.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tools/bench/campaign/plan.h"

namespace vobench::breaking {

// Doses from mild to severe.
struct Scale {
  std::string name, unit;
  double mild = 0, severe = 1;
  bool logarithmic = false;
  std::string limit;  // why it cannot be more severe; empty: no hard limit

  // Value at a fraction of the range; and as text: "12.3 ms".
  double At(double share) const;
  std::string Text(double value) const;
};

// Parameter that makes a scenario harder. `set` are settings with "$x", or "$(A op x)" with one of + - * /, for it.
struct Stress : Scale {
  std::filesystem::path file;  // of its scenario
  campaign::Changes base;      // that the scenario begins with
  campaign::Changes set;
  campaign::Changes SettingsAt(double value) const;  // after `base`
};

struct AccuracyScenario {
  std::string name;
  std::filesystem::path file;
  campaign::Changes set;
  bool there = true;  // whether the file that it `needs` exists
};

struct BenchFile {
  std::filesystem::path file, external;
  std::vector<std::filesystem::path> references;  // cards of other systems
  double error_share_of_spread = 0.5;             // a run with a larger ATE is broken,
  double pose_coverage = 0.5;                     // and one with fewer poses
  int seeds = 8, steps = 32, accuracy_seeds = 3;
  std::vector<AccuracyScenario> accuracy;
  std::vector<Stress> stresses;
  std::vector<Stress> attack;
  int attack_seeds = 4, attack_trials = 200;
};

// `mode` is "quick" or "full": which section of numbers holds. Throws settings::Error with every problem.
BenchFile ReadBenchFile(const std::filesystem::path& file, const std::string& mode);

}  // namespace vobench::breaking
