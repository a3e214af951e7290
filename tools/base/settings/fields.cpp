#include "tools/base/settings/fields.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <stdexcept>

#include "tools/base/settings/quantity.h"

namespace settings {
namespace {

// Whole numbers in full, not as 1e+05.
std::string Plain(double value) {
  const bool whole = std::abs(value) < 1e9 && value == std::floor(value);
  return whole ? std::to_string(static_cast<std::int64_t>(value)) : FormatNumber(value);
}

// Angles in degrees, as they are written.
std::string Number(double value, Unit unit) {
  return Plain(unit == Unit::angle ? value * 180 / std::numbers::pi : value);
}
std::string WithUnit(double value, Unit unit) {
  const std::string_view symbol = unit == Unit::angle ? "deg" : SymbolOf(unit);
  return Number(value, unit) + (symbol.empty() ? "" : " ") + std::string(symbol);
}

}  // namespace

bool Range::Holds(double value) const {
  if (!std::isfinite(value) || value < min || value > max) return false;
  if ((above_min && value == min) || (below_max && value == max)) return false;
  if (kind == Kind::any) return true;
  const auto whole = static_cast<std::int64_t>(value);
  return kind == Kind::odd ? whole % 2 != 0 : std::has_single_bit(static_cast<std::uint64_t>(whole));
}

std::string Describe(const Range& range, Unit unit) {
  const bool from = std::isfinite(range.min), to = std::isfinite(range.max);
  std::string text = range.kind == Range::Kind::odd            ? "odd"
                     : range.kind == Range::Kind::power_of_two ? "a power of two"
                                                               : "";
  const auto add = [&](const std::string& bound) { text += (text.empty() ? "" : " and ") + bound; };
  if (range.kind == Range::Kind::any && from && to && !range.above_min && !range.below_max)
    return Number(range.min, unit) + " ... " + WithUnit(range.max, unit);
  if (from && range.above_min && range.min == 0 && !to) {
    add("positive");
  } else if (from && range.kind != Range::Kind::power_of_two) {
    add((range.above_min ? "above " : "at least ") + (to ? Number(range.min, unit) : WithUnit(range.min, unit)));
  }
  if (to) add((range.below_max ? "below " : "at most ") + WithUnit(range.max, unit));
  return text;
}

std::string Rule(const Range& range, Unit unit) {
  const std::string text = Describe(range, unit);
  if (text.empty()) return "must be finite";
  return (text.find(" ... ") != std::string::npos ? "must lie in " : "must be ") + text;
}

std::string Join(const std::vector<FieldProblem>& problems, const std::string& separator) {
  std::string text;
  for (const FieldProblem& problem : problems)
    text += (text.empty() ? "" : separator) + problem.key + " " + problem.message;
  return text;
}

void ThrowIfAny(const std::vector<FieldProblem>& problems, const std::string& subject) {
  if (!problems.empty()) throw std::invalid_argument(subject + ": " + Join(problems, "; "));
}

void FieldCheck::Require(bool ok, const std::string& key, double value, const std::string& rule) {
  if (!ok) problems.push_back({key, "= " + Plain(value) + " " + rule});
}

void FieldCheck::Check(const char* key, double value, const Field& field) {
  if (field.range.Holds(value)) return;
  problems.push_back({prefix_ + key, "= " + WithUnit(value, field.unit) + " " + Rule(field.range, field.unit)});
}

std::string FieldRows::Text(double value, Unit unit) { return WithUnit(value, unit); }

void FieldRows::Add(const char* key, const std::string& value, const std::string& range, const char* help) {
  const std::string path = prefix_ + key;
  if (std::ranges::none_of(rows, [&](const FieldRow& row) { return row.key == path; }))
    rows.push_back({path, value, range, help});
}

}  // namespace settings
