#include "tools/bench/report/figure.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <iterator>
#include <nlohmann/json.hpp>

#include "tools/bench/text.h"

namespace vobench::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kFormat = "vobench figures 1";

constexpr const char* kDraws[] = {"line", "band", "dots", "bars", "interval"};
constexpr const char* kRoles[] = {"system", "truth", "expected", "context", "warning"};

// Columns of numbers, each once: little-endian floats of 32 bits in base64. A NaN is a NaN.
class Columns {
 public:
  // The number of the column in the JSON's "columns".
  std::size_t Add(const Numbers& numbers) {
    std::string bytes;
    for (const double number : numbers) {
      const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(number));
      for (int k = 0; k < 4; ++k) bytes += static_cast<char>(bits >> (8 * k) & 0xFFu);
    }
    const std::string coded = Base64(bytes);
    const auto at = std::ranges::find(coded_, coded) - coded_.begin();
    if (at == std::ssize(coded_)) coded_.push_back(coded);
    return static_cast<std::size_t>(at);
  }
  const std::vector<std::string>& coded() const { return coded_; }

 private:
  std::vector<std::string> coded_;
};

Json Of(const Axis& axis) {
  Json json = {{"label", axis.label}};
  if (axis.logarithmic) json["logarithmic"] = true;
  if (axis.reversed) json["reversed"] = true;
  if (axis.from_zero) json["from_zero"] = true;
  if (axis.stress) json["stress"] = true;
  if (axis.low) json["low"] = *axis.low;
  if (axis.high) json["high"] = *axis.high;
  return json;
}

Json Of(const Series& series, Columns& columns) {
  Json json = {{"name", series.name},
               {"draw", kDraws[static_cast<std::size_t>(series.draw)]},
               {"role", kRoles[static_cast<std::size_t>(series.role)]},
               {"x", columns.Add(series.x)},
               {"y", columns.Add(series.y)}};
  if (series.role == Role::system) json["system"] = series.system;
  if (series.faint) json["faint"] = true;
  if (!series.high.empty()) json["high"] = columns.Add(series.high);
  if (!series.z.empty()) json["z"] = columns.Add(series.z);
  if (!series.t.empty()) json["t"] = columns.Add(series.t);
  if (!series.notes.empty()) json["notes"] = series.notes;
  return json;
}

Json Of(const Figure& figure, const std::string& id, Columns& columns) {
  const bool in_space = figure.kind == Figure::Kind::space;
  Json json = {
      {"id", id}, {"title", figure.title}, {"description", figure.description}, {"kind", in_space ? "space" : "plane"}};
  if (in_space) {
    json["up"] = figure.up;
  } else {
    json["x"] = Of(figure.x);
    json["y"] = Of(figure.y);
    if (figure.equal_scale) json["equal_scale"] = true;
  }
  json["series"] = Json::array();
  for (const Series& series : figure.series) json["series"].push_back(Of(series, columns));
  return json;
}

}  // namespace

Series LineOf(const std::string& system, std::size_t number, Numbers x, Numbers y) {
  Series line = LineAs(Role::system, DisplayName(system), std::move(x), std::move(y));
  line.system = number;
  return line;
}

Series LineAs(Role role, const std::string& name, Numbers x, Numbers y) {
  return {name, Draw::line, role, 0, false, std::move(x), std::move(y)};
}

Series Band(const std::string& name, Numbers x, Numbers low, Numbers high) {
  Series band = LineAs(Role::expected, name, std::move(x), std::move(low));
  band.draw = Draw::band;
  band.high = std::move(high);
  return band;
}

Series Faint(Series series) {
  series.faint = true;
  return series;
}

std::string FiguresJson(const std::vector<std::string>& systems, const std::vector<Figure>& figures, const Json& more) {
  Columns columns;
  Json json = {{"format", kFormat}, {"systems", systems}, {"figures", Json::array()}};
  for (std::size_t i = 0; i < figures.size(); ++i) {
    json["figures"].push_back(Of(figures[i], "f" + std::to_string(i), columns));
  }
  json["columns"] = columns.coded();
  if (more.is_object()) json.update(more);
  std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace), safe;
  safe.reserve(text.size());
  for (const char c : text) c == '<' ? safe += "\\u003c" : safe += c;
  return safe;
}

}  // namespace vobench::report
