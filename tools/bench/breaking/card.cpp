#include "tools/bench/breaking/card.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "tools/bench/text.h"

namespace nlohmann {

template <class T>
struct adl_serializer<std::optional<T>> {
  static void to_json(json& to, const std::optional<T>& from) { to = from ? json(*from) : json(); }
  static void from_json(const json& from, std::optional<T>& to) {
    to = from.is_null() ? std::nullopt : std::optional(from.get<T>());
  }
};

}  // namespace nlohmann

namespace vobench::breaking {

using End = Breaking::End;
constexpr const char* kFormat = "vobench card 1";

NLOHMANN_JSON_SERIALIZE_ENUM(Breaking::End, {{End::inside, "inside"},
                                             {End::at_the_mildest, "at_the_mildest"},
                                             {End::not_reached, "not_reached"}})
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(StepRuns, step, runs, broken)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Breaking, end, at, low, high)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(StressResult, name, unit, limit, mild, severe, logarithmic, done, breaking)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(AccuracyResult, scenario, runs, lost, ate_share_of_path, drift, nees, nis)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Cost, tracking_s, memory_mb)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Card, system, mode, steps, seeds, accuracy, left_out, stresses, cost)

std::string BreakingText(const StressResult& stress) {
  const auto& b = stress.breaking;
  const auto text = [&](double share) { return stress.Text(stress.At(share)); };
  if (!b) return "not measured";
  if (b->end == End::at_the_mildest) return "broken at " + text(0) + ", the mildest";
  if (b->end == End::inside) return fmt::format("{} [{} to {}]", text(b->at), text(b->low), text(b->high));
  return "not broken at " + text(1) + (stress.limit.empty() ? "" : ", its limit: " + stress.limit);
}

std::string ToJson(const Card& card) {
  nlohmann::json json = card;
  json["format"] = kFormat;
  return json.dump(1) + "\n";
}

Card CardFromJson(const std::string& text) {
  try {
    const auto json = nlohmann::json::parse(text);
    if (json.at("format") != kFormat) throw std::invalid_argument("format " + json["format"].dump());
    return json.get<Card>();
  } catch (const nlohmann::json::exception& error) {
    throw std::invalid_argument(std::string("is no card: ") + error.what());
  }
}

std::string CardText(const Card& card) {
  std::vector<std::vector<std::string>> rows = {{"stress", "breaking point, with 90 % interval", "doses"}};
  for (const StressResult& stress : card.stresses)
    rows.push_back({stress.name, BreakingText(stress), std::to_string(stress.done.size())});
  return AlignedTable(rows);
}

}  // namespace vobench::breaking
