#include "tools/bench/campaign/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "tools/base/limits/structured_text.h"

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

Value PerDof(const std::optional<evaluation::NeesSummary>& nees) {
  return nees && nees->frames > 0 ? Per(nees->mean, nees->dof) : std::nullopt;
}

Value MedianPerDof(const std::optional<evaluation::NeesSummary>& nees) {
  return nees && nees->frames > 0 ? Per(nees->median, nees->dof) : std::nullopt;
}

Value Rmse(const evaluation::Statistics& statistics) {
  return statistics.count > 0 ? Value(statistics.rmse) : std::nullopt;
}

std::optional<evaluation::NeesSummary> Pose(const Metrics& m) {
  return m.consistency ? std::optional(m.consistency->pose) : std::nullopt;
}
std::optional<evaluation::NeesSummary> ScaleFree(const Metrics& m) {
  return m.consistency ? std::optional(m.consistency->pose_scale_free) : std::nullopt;
}
std::optional<evaluation::NeesSummary> Velocity(const Metrics& m) {
  return m.consistency ? m.consistency->velocity : std::nullopt;
}

// Columns of results.csv between `status` and `reason`, once: name, unit, whether larger is better, value. A column is
// added here, and to the table in docs/campaign.md; task.json and results.csv are written and read by name.
struct Column {
  const char* name;
  const char* unit;
  bool larger_is_better;
  Value (*of)(const Metrics& metrics, evaluation::Alignment align);
};

using A = evaluation::Alignment;
constexpr Column kColumns[] = {
    {"ate_m", "m", false, [](const Metrics& m, A align) { return Rmse(m.errors.Aligned(align).position); }},
    {"ate_none_m", "m", false, [](const Metrics& m, A) { return Rmse(m.errors.none.position); }},
    {"ate_se3_m", "m", false, [](const Metrics& m, A) { return Rmse(m.errors.se3.position); }},
    {"ate_sim3_m", "m", false, [](const Metrics& m, A) { return Rmse(m.errors.sim3.position); }},
    {"ate_first_m", "m", false, [](const Metrics& m, A) { return Rmse(m.errors.first.position); }},
    {"ate_orientation_rad", "rad", false,
     [](const Metrics& m, A align) { return Rmse(m.errors.Aligned(align).orientation); }},
    {"ate_share_of_path", "1", false,
     [](const Metrics& m, A align) { return Per(m.errors.Aligned(align).position.rmse, m.path_length_m); }},
    {"rpe_m", "m", false, [](const Metrics& m, A) { return Rmse(m.errors.rpe.position_statistics); }},
    {"rpe_unscaled_m", "m", false, [](const Metrics& m, A) { return Rmse(m.errors.rpe_unscaled.position_statistics); }},
    {"rpe_orientation_rad", "rad", false,
     [](const Metrics& m, A) { return Rmse(m.errors.rpe.orientation_statistics); }},
    {"rpe_pairs_share", "1", true,
     [](const Metrics& m, A) {
       return Per(static_cast<double>(m.errors.rpe.pairs.size()), static_cast<double>(m.errors.rpe_pairs_offered));
     }},
    {"scale", "1", false, [](const Metrics& m, A) { return Value(m.errors.sim3.similarity.scale); }},
    {"pose_coverage", "1", true,
     [](const Metrics& m, A) { return m.coverage ? Value(m.coverage->pose_coverage()) : std::nullopt; }},
    {"tracked_coverage", "1", true,
     [](const Metrics& m, A) { return m.coverage ? m.coverage->tracked_coverage() : std::nullopt; }},
    {"nees_pose_per_dof", "1", false, [](const Metrics& m, A) { return PerDof(Pose(m)); }},
    {"nees_pose_median_per_dof", "1", false, [](const Metrics& m, A) { return MedianPerDof(Pose(m)); }},
    {"nees_pose_scale_free_per_dof", "1", false, [](const Metrics& m, A) { return PerDof(ScaleFree(m)); }},
    {"nees_velocity_per_dof", "1", false, [](const Metrics& m, A) { return PerDof(Velocity(m)); }},
    {"nees_velocity_median_per_dof", "1", false, [](const Metrics& m, A) { return MedianPerDof(Velocity(m)); }},
    {"nis_per_dof", "1", false, [](const Metrics& m, A) { return m.nis ? Value(m.nis->mean_per_dof) : std::nullopt; }},
    {"path_length_m", "m", false, [](const Metrics& m, A) { return Value(m.path_length_m); }},
    {"duration_s", "s", false, [](const Metrics& m, A) { return Value(m.duration_s); }},
    {"constant_velocity_ate_m", "m", false,
     [](const Metrics& m, A align) { return Rmse(m.constant_velocity.Aligned(align).position); }},
    {"constant_velocity_rpe_m", "m", false,
     [](const Metrics& m, A) { return Rmse(m.constant_velocity.rpe.position_statistics); }},
};

template <class Number>
Number Whole(const Json& json, const char* name) {
  const auto number = limits::WholeNumber<Number>(json.at(name));
  if (!number) throw std::invalid_argument("'" + std::string(name) + "' is no whole number: " + json.at(name).dump());
  return *number;
}

}  // namespace

std::string Name(Status status) {
  return std::find_if(kStatuses.begin(), kStatuses.end(), [&](const auto& s) { return s.first == status; })->second;
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

std::string UnitOf(const std::string& metric) { return kColumns[MetricIndex(metric)].unit; }

double ValueOf(const TaskRecord& record, std::size_t metric) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (record.status == Status::failed) return kNone;
  if (record.status != Status::ok) return LargerIsBetter(MetricNames().at(metric)) ? -kInfinity : kInfinity;
  return metric < record.metrics.size() ? record.metrics[metric].value_or(kNone) : kNone;
}

std::size_t MetricIndex(const std::string& metric) {
  const std::vector<std::string>& names = MetricNames();
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), metric) - names.begin());
}

bool IsLost(const TaskRecord& record, const LostRule& rule) {
  const auto value = [&](const char* name) -> Value {
    const std::size_t index = MetricIndex(name);
    return index < record.metrics.size() ? record.metrics[index] : Value();
  };
  const Value pose = value("pose_coverage"), tracked = value("tracked_coverage"), error = value("ate_m");
  if ((pose && *pose < rule.pose_coverage) || (tracked && *tracked < rule.tracked_coverage)) return true;
  return rule.error_m > 0 && !(error && *error <= rule.error_m);
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
    const auto found =
        std::find_if(kStatuses.begin(), kStatuses.end(), [&](const auto& s) { return s.second == status; });
    if (found == kStatuses.end()) throw std::invalid_argument("no status '" + status + "'");
    record.status = found->first;
    if (!json.at("metrics").empty()) {
      for (const std::string& name : MetricNames()) {
        const Json& value = json.at("metrics").at(name);
        record.metrics.push_back(value.is_null() ? Value() : Value(value.get<double>()));
      }
    }
    return record;
  } catch (const Json::exception& error) {
    throw std::invalid_argument(error.what());
  }
}

std::string OneLine(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return text;
}

std::string CsvField(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string ResultsCsv(const Campaign& campaign, const std::vector<TaskRecord>& records) {
  std::string csv = "task,scenario";
  for (const Factor& factor : campaign.factors) csv += "," + CsvField(factor.name);
  csv += ",system,seed,status";
  for (const std::string& name : MetricNames()) csv += "," + name;
  csv += ",reason\n";
  for (const TaskRecord& record : records) {
    csv += fmt::format("{},{}", record.task, CsvField(record.scenario));
    for (const auto& [name, value] : record.levels) csv += "," + CsvField(value);
    csv += fmt::format(",{},{},{}", CsvField(record.system), record.seed, Name(record.status));
    for (std::size_t i = 0; i < MetricNames().size(); ++i) {
      csv += ",";
      if (i < record.metrics.size() && record.metrics[i]) csv += fmt::format("{}", *record.metrics[i]);
    }
    csv += "," + CsvField(record.reason) + "\n";
  }
  return csv;
}

}  // namespace vobench::campaign
