// Result of one task, as a line of results.csv (docs/campaign.md). Its columns: results.cpp, kColumns.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/bench/campaign/plan.h"
#include "tools/judge/evaluation/summary.h"

namespace vobench::campaign {

enum class Status {
  ok,
  lost,       // by the campaign's rule
  crashed,    // external program: ended by a signal or with a status that is not 0
  timed_out,  // the same, longer than its entry allows
  no_answer,  // the same, without a trajectory that can be evaluated
  failed,     // no result: the task is tried again by the next start
};

std::string Name(Status status);

// By factor: a number in SI where it is one.
using LevelValues = std::vector<std::pair<std::string, std::string>>;

struct TaskRecord {
  std::string key;  // of all that the result depends on: docs/campaign.md, "When the file changes"
  std::int64_t task = 0;
  std::string scenario, system;
  LevelValues levels;
  std::uint64_t seed = 0;
  Status status = Status::failed;
  std::string reason{};                          // of what is not ok, or a remark; ToJson makes it one line
  std::vector<std::optional<double>> metrics{};  // in the order of MetricNames; none at all where nothing was judged

  std::optional<double> metric(std::size_t index) const {
    return index < metrics.size() ? metrics[index] : std::nullopt;
  }
  void AddReason(const std::string& another) { reason += (reason.empty() ? "" : "; ") + another; }
};

// Columns with their units: "ate_m", "rpe_orientation_rad", ...
const std::vector<std::string>& MetricNames();
std::vector<std::optional<double>> MetricValues(const evaluation::Metrics& metrics, evaluation::Alignment align);

// True of shares of answered frames; of all other metrics a smaller value is better.
bool LargerIsBetter(const std::string& metric);
// Whether it depends on the alignment of a system: "ate_m", but not "ate_se3_m".
bool IsAligned(const std::string& metric);
// "m", "rad" or "s", with which the name ends; else "1".
std::string UnitOf(const std::string& metric);

// A run's value of a metric, by its index in MetricNames: infinite where it is lost or has no answer, NaN where there
// is none, or the task failed. Coverage is unchanged, and 0 without an answer.
double ValueOf(const TaskRecord& record, std::size_t metric);
// Its index; the number of metrics where there is no such metric.
std::size_t MetricIndex(const std::string& metric);

// Why an evaluated task counts as lost; empty where it does not.
std::string WhyLost(const TaskRecord& record, const LostRule& rule);

// task.json. Reading throws std::invalid_argument for invalid text.
std::string ToJson(const TaskRecord& record);
TaskRecord RecordFromJson(const std::string& text);

// The records whose system is evaluated after this alignment.
std::vector<TaskRecord> Aligned(const Campaign& campaign, const std::vector<TaskRecord>& records,
                                evaluation::Alignment alignment);

// results.csv: a header, and a line for each record in their order.
std::string ResultsCsv(const Campaign& campaign, const std::vector<TaskRecord>& records);

// With a space for each line break.
std::string OneLine(const std::string& text);

// One field of a CSV line, quoted where it must be.
std::string CsvField(const std::string& text);

}  // namespace vobench::campaign
