// Campaign as plain values: scenarios x varied settings x systems x seeds, and the choice of task k.
// Source: docs/campaign.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/bench/campaign/external_system.h"
#include "tools/judge/evaluation/ate.h"

namespace vobench::campaign {

// Dotted keys with their values as YAML, a later one wins: the arguments of `--set`.
using Changes = std::vector<std::pair<std::string, std::string>>;

// Frames of a recorded sequence.
struct RecordedFrames {
  std::optional<std::string> camera;  // a preset, or a file; none: the sequence's own
  std::int64_t first = 0;
  std::optional<std::int64_t> count;  // none: all that follow
};

struct ScenarioEntry {
  std::string name;
  std::filesystem::path file;                 // of a recorded sequence its folder
  Changes set;                                // of a recorded sequence: of odometry and prior
  std::map<std::string, Changes> for_system;  // by the system's name: of odometry and prior
  std::optional<RecordedFrames> recorded = {};
};

// One value of something that is varied.
struct Level {
  std::string name;  // as the file writes it: "4 ms"
  Changes set;
};

struct Factor {
  std::string name;
  std::string key;  // of a factor that changes one setting; else empty
  std::vector<Level> levels;
};

struct SystemEntry {
  std::string name;
  std::string system;       // one of ours; empty: an external one
  Changes set;              // of odometry and prior
  ExternalSystem external;  // where system is empty
};

// Criterion of a lost run: poses, or tracking, for less than these shares of the frames, or a larger error.
struct LostRule {
  double pose_coverage = 0.5;
  double tracked_coverage = 0.5;
  double error_m = 0;  // ATE after the alignment of the campaign; 0: however large
};

// Frames excluded from evaluation, as if the sequence did not have them. Empty where until_s is not above from_s.
struct Omitted {
  double from_s = 0, until_s = 0;
  bool empty() const { return !(until_s > from_s); }
};

// Published numbers of other authors.
struct ReferenceColumn {
  std::string name;
  std::map<std::string, std::string> values;  // by the level of the table's only row name; "-" where there is none
};

// Medians over seeds, and over whatever is neither in rows nor in columns.
struct TableSpec {
  std::string metric;  // a column of results.csv
  std::string title;
  std::vector<std::string> rows, columns;    // "scenario", "system" or the name of a factor
  double unit_in_si = 1;                     // of the numbers that are printed
  std::vector<ReferenceColumn> beside = {};  // more columns, behind ours
};

// How results change along one setting that is varied: docs/campaign.md, "Curves".
struct CurveSpec {
  std::string along;                 // the name of a factor
  std::vector<double> doses;         // its levels in SI; the file's order is that of stress, so they rise or fall
  std::string unit;                  // as the file writes them: "ms"; empty where it writes none
  double unit_in_si = 1;             // one of it
  std::vector<std::string> metrics;  // columns of results.csv
  std::vector<std::string> by;       // a curve for each level of these: "scenario", or the names of factors
  double break_error_m = 0;          // a run with a larger ate_m has broken, as a lost one has; 0: lost ones only
};

// Files of a task beside task.json and times.json: none; metrics.json and estimate.txt; covariance.txt, frames.csv and
// the truth, too.
enum class Keep { numbers, estimate, all };

struct Campaign {
  std::string name;
  std::vector<ScenarioEntry> scenarios;
  std::vector<Factor> factors;
  std::vector<SystemEntry> systems;
  std::vector<std::uint64_t> seeds;
  evaluation::Alignment align = evaluation::Alignment::sim3;  // but AlignmentOf a system
  Omitted omit;
  LostRule lost;
  std::vector<TableSpec> tables;
  std::vector<CurveSpec> curves;
  Keep keep = Keep::estimate;
  std::string resolved;  // all of it, defaults included, as JSON
};

// Alignment for the errors of a system: the campaign's, but for a metric system its own instead of Sim(3).
evaluation::Alignment AlignmentOf(const Campaign& campaign, const SystemEntry& system);
// Of its systems, each once, in their order.
std::vector<evaluation::Alignment> AlignmentsOf(const Campaign& campaign);

// Choice of task k.
struct TaskChoice {
  std::size_t scenario = 0;
  std::vector<std::size_t> levels;  // one for each factor
  std::size_t system = 0;
  std::size_t seed = 0;
  // Scenario and levels as one number, 0 ... Points(campaign) - 1.
  std::size_t point = 0;
};

std::size_t Points(const Campaign& campaign);
std::int64_t Tasks(const Campaign& campaign);

// Digits of k, the slowest first: seed, scenario, factors in the order of the file, system. Adding seeds keeps the
// numbers of all tasks. Throws std::out_of_range.
TaskChoice ChoiceOf(const Campaign& campaign, std::int64_t task);

// Settings of the scenario at a point, in the order in which they apply; and those of odometry and prior of a system.
Changes ChangesAt(const Campaign& campaign, const TaskChoice& choice);

// Names of the varied settings: "scenario" and the factors.
std::vector<std::string> VariedNames(const Campaign& campaign);
// Levels of a task by name ("scenario", "system" or a factor), as the file writes them.
std::vector<std::string> LevelsOf(const Campaign& campaign, const std::vector<std::string>& names,
                                  const TaskChoice& choice);

// "tiny, blur 4 ms, rb2pf, seed 3"
std::string Describe(const Campaign& campaign, const TaskChoice& choice);

}  // namespace vobench::campaign
