#include "tools/bench/breaking/card.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "tools/bench/text.h"

namespace vobench::breaking {
namespace {

using Json = nlohmann::ordered_json;
using End = Breaking::End;
constexpr const char* kFormat = "vobench card 1";
constexpr const char* kEnds[] = {"inside", "at_the_mildest", "not_reached"};

Json OrNull(const std::optional<double>& value) { return value ? Json(*value) : Json(); }
std::optional<double> OrNone(const Json& json) {
  return json.is_null() ? std::nullopt : std::optional(json.get<double>());
}

Json ToJson(const StressResult& stress) {
  Json json = {{"name", stress.name},  {"unit", stress.unit},     {"scale", stress.logarithmic ? "log" : "linear"},
               {"mild", stress.mild},  {"severe", stress.severe}, {"limit", stress.limit},
               {"runs", Json::array()}};
  for (const StepRuns& step : stress.done) {
    json["runs"].push_back({{"step", step.step}, {"runs", step.runs}, {"broken", step.broken}});
  }
  if (const auto& b = stress.breaking) {
    json["breaking"] = {{"end", kEnds[static_cast<int>(b->end)]}, {"at", b->at}, {"low", b->low}, {"high", b->high}};
  }
  return json;
}

StressResult StressFrom(const Json& json) {
  StressResult stress{json.at("name"),
                      json.at("unit"),
                      json.at("limit"),
                      json.at("mild"),
                      json.at("severe"),
                      json.at("scale") == "log",
                      {},
                      {}};
  for (const Json& step : json.at("runs")) stress.done.push_back({step.at("step"), step.at("runs"), step.at("broken")});
  if (!json.contains("breaking")) return stress;
  const Json& b = json["breaking"];
  const auto end = std::ranges::find(kEnds, b.at("end").get<std::string>());
  if (end == std::end(kEnds)) throw std::invalid_argument("'end': " + b.at("end").dump());
  stress.breaking = {static_cast<End>(end - std::begin(kEnds)), b.at("at"), b.at("low"), b.at("high")};
  return stress;
}

}  // namespace

std::string Text(const StressResult& stress, double share) {
  const Stress scale{stress.name, stress.unit, {}, {}, {}, stress.mild, stress.severe, stress.logarithmic, ""};
  return scale.Text(scale.At(share));
}

std::string BreakingText(const StressResult& stress) {
  const auto& b = stress.breaking;
  if (!b) return "not measured";
  if (b->end == End::at_the_mildest) return "broken at " + Text(stress, 0) + ", the mildest";
  if (b->end == End::not_reached) {
    const bool physical = !stress.limit.empty();
    return fmt::format("not broken at {}{}", Text(stress, 1), physical ? ", its limit: " + stress.limit : "");
  }
  const std::string low = Text(stress, b->low);
  const std::string number = low.substr(0, low.size() - (stress.unit.empty() ? 0 : stress.unit.size() + 1));
  return fmt::format("{} [{} to {}]", Text(stress, b->at), number, Text(stress, b->high));
}

std::string ToJson(const Card& card) {
  Json json = {{"format", kFormat},         {"system", card.system},    {"mode", card.mode},
               {"steps", card.steps},       {"seeds", card.seeds},      {"accuracy", Json::array()},
               {"left_out", card.left_out}, {"stresses", Json::array()}};
  for (const AccuracyResult& a : card.accuracy) {
    json["accuracy"].push_back({{"scenario", a.scenario},
                                {"runs", a.runs},
                                {"lost", a.lost},
                                {"ate_share_of_path", OrNull(a.ate_share_of_path)},
                                {"drift", OrNull(a.drift)},
                                {"nees_pose_per_dof", OrNull(a.nees)},
                                {"nis_per_dof", OrNull(a.nis)}});
  }
  for (const StressResult& stress : card.stresses) json["stresses"].push_back(ToJson(stress));
  if (card.cost) json["cost"] = {{"tracking_s", card.cost->seconds}, {"memory_mb", card.cost->memory_mb}};
  return json.dump(1) + "\n";
}

Card CardFromJson(const std::string& text) {
  try {
    const Json json = Json::parse(text);
    if (json.at("format") != kFormat) throw std::invalid_argument("format " + json["format"].dump());
    Card card{json.at("system"), json.at("mode"), json.at("steps"), json.at("seeds"), {}, json.at("left_out"), {}, {}};
    for (const Json& a : json.at("accuracy")) {
      card.accuracy.push_back({a.at("scenario"), a.at("runs"), a.at("lost"), OrNone(a.at("ate_share_of_path")),
                               OrNone(a.at("drift")), OrNone(a.at("nees_pose_per_dof")), OrNone(a.at("nis_per_dof"))});
    }
    for (const Json& stress : json.at("stresses")) card.stresses.push_back(StressFrom(stress));
    if (json.contains("cost")) card.cost = {json["cost"].at("tracking_s"), json["cost"].at("memory_mb")};
    return card;
  } catch (const Json::exception& error) {
    throw std::invalid_argument(std::string("is no card: ") + error.what());
  }
}

std::string CardText(const Card& card) {
  std::vector<std::vector<std::string>> rows = {{"stress", "breaking point, with 90 % interval", "doses"}};
  for (const StressResult& stress : card.stresses) {
    rows.push_back({stress.name, BreakingText(stress), std::to_string(stress.done.size())});
  }
  std::string text = AlignedTable(rows) + "\n";
  rows = {{"accuracy", "lost", "ATE [% of path]", "drift [% of path]", "NEES", "NIS"}};
  const auto number = [](const std::optional<double>& value, double factor) {
    return value ? Readable(factor * *value) : "–";
  };
  for (const AccuracyResult& a : card.accuracy) {
    rows.push_back({a.scenario, fmt::format("{} of {}", a.lost, a.runs), number(a.ate_share_of_path, 100),
                    number(a.drift, 100), number(a.nees, 1), number(a.nis, 1)});
  }
  return text + AlignedTable(rows);
}

}  // namespace vobench::breaking
