#include "tools/bench/campaign/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "tools/base/limits/structured_text.h"
#include "tools/bench/text.h"

namespace vobench::campaign {
namespace {

using Json = nlohmann::ordered_json;
using evaluation::Metrics;
using Value = std::optional<double>;

constexpr const char* kFormat = "vobench campaign task 1";

const std::vector<std::pair<Status, std::string>> kStatuses = {{Status::ok, "ok"},
                                                               {Status::lost, "lost"},
                                                               {Status::crashed, "crashed"},
                                                               {Status::timed_out, "timed_out"},
                                                               {Status::no_answer, "no_answer"},
                                                               {Status::failed, "failed"}};

Value Per(double sum, double count) { return count > 0 ? Value(sum / count) : std::nullopt; }

Value Rmse(const evaluation::Statistics& statistics) {
  return statistics.count > 0 ? Value(statistics.rmse) : std::nullopt;
}

using evaluation::NeesSummary;
using Consistency = evaluation::ConsistencySummary;

// Translations times the scale of the alignment.
Value RpeRmse(const evaluation::TrajectoryErrors& errors, evaluation::Alignment align) {
  const bool scaled = align == evaluation::Alignment::sim3;
  return Rmse((scaled ? errors.rpe : errors.rpe_unscaled).position_statistics);
}

// Mean or median of the NEES of a part of the state.
template <class Part>
Value NeesPerDof(const Metrics& m, Part Consistency::*part, double NeesSummary::*statistic) {
  if (!m.consistency) return std::nullopt;
  const std::optional<NeesSummary> nees = (*m.consistency).*part;
  return nees && nees->frames > 0 ? Per((*nees).*statistic, nees->dof) : std::nullopt;
}

// Columns of results.csv between `status` and `reason`, once: name with its unit, whether larger is better, value. A
// column is added here, and to the table in docs/campaign.md; task.json and results.csv are written and read by name.
struct Column {
  const char* name;
  bool larger_is_better;
  Value (*of)(const Metrics& metrics, evaluation::Alignment align);
};

using A = evaluation::Alignment;
constexpr Column kColumns[] = {
    {"ate_m", false, [](const Metrics& m, A align) { return Rmse(m.errors.Aligned(align).position); }},
    {"ate_live_m", false,
     [](const Metrics& m, A align) { return m.live ? Rmse(m.live->Aligned(align).position) : std::nullopt; }},
    {"ate_none_m", false, [](const Metrics& m, A) { return Rmse(m.errors.none.position); }},
    {"ate_se3_m", false, [](const Metrics& m, A) { return Rmse(m.errors.se3.position); }},
    {"ate_sim3_m", false, [](const Metrics& m, A) { return Rmse(m.errors.sim3.position); }},
    {"ate_first_m", false, [](const Metrics& m, A) { return Rmse(m.errors.first.position); }},
    {"ate_yaw_m", false, [](const Metrics& m, A) { return Rmse(m.errors.yaw.position); }},
    {"ate_orientation_rad", false, [](const Metrics& m, A align) { return Rmse(m.errors.Aligned(align).orientation); }},
    {"ate_share_of_path", false,
     [](const Metrics& m, A align) { return Per(m.errors.Aligned(align).position.rmse, m.path_length_m); }},
    {"ate_share_of_spread", false,
     [](const Metrics& m, A align) { return Per(m.errors.Aligned(align).position.rmse, m.spread_m); }},
    {"rpe_m", false, [](const Metrics& m, A align) { return RpeRmse(m.errors, align); }},
    {"rpe_unscaled_m", false, [](const Metrics& m, A) { return Rmse(m.errors.rpe_unscaled.position_statistics); }},
    {"rpe_orientation_rad", false, [](const Metrics& m, A) { return Rmse(m.errors.rpe.orientation_statistics); }},
    {"rpe_pairs_share", true,
     [](const Metrics& m, A) {
       return Per(static_cast<double>(m.errors.rpe.pairs.size()), static_cast<double>(m.errors.rpe_pairs_offered));
     }},
    {"scale", false, [](const Metrics& m, A) { return Value(m.errors.sim3.similarity.scale); }},
    {"pose_coverage", true,
     [](const Metrics& m, A) { return m.coverage ? Value(m.coverage->pose_coverage()) : std::nullopt; }},
    {"tracked_coverage", true,
     [](const Metrics& m, A) { return m.coverage ? m.coverage->tracked_coverage() : std::nullopt; }},
    {"nees_pose_per_dof", false,
     [](const Metrics& m, A) { return NeesPerDof(m, &Consistency::pose, &NeesSummary::mean); }},
    {"nees_pose_median_per_dof", false,
     [](const Metrics& m, A) { return NeesPerDof(m, &Consistency::pose, &NeesSummary::median); }},
    {"nees_pose_scale_free_per_dof", false,
     [](const Metrics& m, A) { return NeesPerDof(m, &Consistency::pose_scale_free, &NeesSummary::mean); }},
    {"nees_velocity_per_dof", false,
     [](const Metrics& m, A) { return NeesPerDof(m, &Consistency::velocity, &NeesSummary::mean); }},
    {"nees_velocity_median_per_dof", false,
     [](const Metrics& m, A) { return NeesPerDof(m, &Consistency::velocity, &NeesSummary::median); }},
    {"nis_per_dof", false, [](const Metrics& m, A) { return m.nis ? Value(m.nis->mean_per_dof) : std::nullopt; }},
    {"path_length_m", false, [](const Metrics& m, A) { return Value(m.path_length_m); }},
    {"duration_s", false, [](const Metrics& m, A) { return Value(m.duration_s); }},
    {"constant_velocity_ate_m", false,
     [](const Metrics& m, A align) { return Rmse(m.constant_velocity.Aligned(align).position); }},
    {"constant_velocity_rpe_m", false, [](const Metrics& m, A align) { return RpeRmse(m.constant_velocity, align); }},
};

template <class Number>
Number Whole(const Json& json, const char* name) {
  const auto number = limits::WholeNumber<Number>(json.at(name));
  if (!number) throw std::invalid_argument("'" + std::string(name) + "' is no whole number: " + json.at(name).dump());
  return *number;
}

}  // namespace

std::string Name(Status status) {
  return std::ranges::find(kStatuses, status, &std::pair<Status, std::string>::first)->second;
}

const std::vector<std::string>& MetricNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Column& column : kColumns) all.emplace_back(column.name);
    return all;
  }();
  return names;
}

std::vector<Value> MetricValues(const Metrics& metrics, evaluation::Alignment align) {
  std::vector<Value> values;
  for (const Column& column : kColumns) {
    const Value value = column.of(metrics, align);
    values.push_back(value && std::isfinite(*value) ? value : std::nullopt);
  }
  return values;
}

bool LargerIsBetter(const std::string& metric) {
  const std::size_t index = MetricIndex(metric);
  return index < std::size(kColumns) && kColumns[index].larger_is_better;
}

bool IsAligned(const std::string& metric) {
  constexpr const char* kOthers[] = {"ate_m", "ate_live_m", "ate_orientation_rad", "ate_share_of_path", "rpe_m"};
  return metric.starts_with("constant_velocity_") || std::ranges::count(kOthers, metric) > 0;
}

std::vector<TaskRecord> Aligned(const Campaign& campaign, const std::vector<TaskRecord>& records,
                                evaluation::Alignment alignment) {
  std::vector<TaskRecord> some = records;
  std::erase_if(some, [&](const TaskRecord& record) {
    return AlignmentOf(campaign, campaign.systems[ChoiceOf(campaign, record.task).system]) != alignment;
  });
  return some;
}

std::string UnitOf(const std::string& metric) {
  for (const std::string unit : {"m", "rad", "s"}) {
    if (metric.ends_with("_" + unit)) return unit;
  }
  return "1";
}

double ValueOf(const TaskRecord& record, std::size_t metric) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (record.status == Status::failed) return kNone;
  const std::string& name = MetricNames().at(metric);
  if (name == "pose_coverage" || name == "tracked_coverage") {  // the reason of a lost run
    return record.status == Status::ok || record.status == Status::lost ? record.metric(metric).value_or(kNone) : 0;
  }
  if (record.status != Status::ok) return LargerIsBetter(name) ? -kInfinity : kInfinity;
  return record.metric(metric).value_or(kNone);
}

std::size_t MetricIndex(const std::string& metric) {
  const std::vector<std::string>& names = MetricNames();
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), metric) - names.begin());
}

std::string WhyLost(const TaskRecord& record, const LostRule& rule) {
  const auto value = [&](const char* name) { return record.metric(MetricIndex(name)); };
  const Value pose = value("pose_coverage"), tracked = value("tracked_coverage"), error = value("ate_m");
  if (pose && *pose < rule.pose_coverage) return fmt::format("a pose in {:.1f} % of the frames", 100 * *pose);
  if (tracked && *tracked < rule.tracked_coverage)
    return fmt::format("tracked in {:.1f} % of the frames", 100 * *tracked);
  if (rule.error_m > 0 && !(error && *error <= rule.error_m)) return fmt::format("an ATE above {:g} m", rule.error_m);
  return "";
}

std::string ToJson(const TaskRecord& record) {
  Json json = {{"format", kFormat},
               {"key", record.key},
               {"task", record.task},
               {"scenario", record.scenario},
               {"levels", Json::array()},
               {"system", record.system},
               {"seed", record.seed},
               {"status", Name(record.status)},
               {"reason", OneLine(record.reason)},
               {"metrics", Json::object()}};
  for (const auto& [name, value] : record.levels) json["levels"].push_back({name, value});
  for (std::size_t i = 0; i < record.metrics.size(); ++i) {
    json["metrics"][MetricNames()[i]] = record.metrics[i] ? Json(*record.metrics[i]) : Json();
  }
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

TaskRecord RecordFromJson(const std::string& text) {
  if (const std::string problem = limits::JsonProblem(text); !problem.empty()) throw std::invalid_argument(problem);
  try {
    const Json json = Json::parse(text);
    if (json.at("format") != kFormat) throw std::invalid_argument("not the format '" + std::string(kFormat) + "'");
    TaskRecord record;
    record.key = json.at("key");
    record.task = Whole<std::int64_t>(json, "task");
    record.scenario = json.at("scenario");
    record.system = json.at("system");
    record.seed = Whole<std::uint64_t>(json, "seed");
    record.reason = json.at("reason");
    record.levels = json.at("levels").get<LevelValues>();
    const std::string status = json.at("status");
    const auto found = std::ranges::find(kStatuses, status, &std::pair<Status, std::string>::second);
    if (found == kStatuses.end()) throw std::invalid_argument("no status '" + status + "'");
    record.status = found->first;
    if (!json.at("metrics").empty()) {
      for (const std::string& name : MetricNames()) {
        const Json value = json.at("metrics").value(name, Json());  // null in records of programs without the column
        record.metrics.push_back(value.is_null() ? Value() : Value(value.get<double>()));
      }
    }
    return record;
  } catch (const Json::exception& error) {
    throw std::invalid_argument(error.what());
  }
}

std::string OneLine(const std::string& text) { return Replaced(text, {{'\n', " "}, {'\r', " "}}); }

std::string CsvField(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  return '"' + Replaced(text, {{'"', "\"\""}}) + '"';
}

std::string ResultsCsv(const Campaign& campaign, const std::vector<TaskRecord>& records) {
  std::string csv = "task,scenario";
  for (const Factor& factor : campaign.factors) csv += "," + CsvField(factor.name);
  csv += ",system,seed,status,alignment";
  for (const std::string& name : MetricNames()) csv += "," + name;
  csv += ",reason\n";
  for (const TaskRecord& record : records) {
    csv += fmt::format("{},{}", record.task, CsvField(record.scenario));
    for (const auto& [name, value] : record.levels) csv += "," + CsvField(value);
    const SystemEntry& system = campaign.systems[ChoiceOf(campaign, record.task).system];
    csv += fmt::format(",{},{},{},{}", CsvField(record.system), record.seed, Name(record.status),
                       evaluation::Name(AlignmentOf(campaign, system)));
    for (std::size_t i = 0; i < MetricNames().size(); ++i) {
      csv += ",";
      if (const Value value = record.metric(i)) csv += fmt::format("{}", *value);
    }
    csv += "," + CsvField(record.reason) + "\n";
  }
  return csv;
}

}  // namespace vobench::campaign
