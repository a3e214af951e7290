#include "tools/base/settings/quantity.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <span>
#include <system_error>

#include "tools/base/text.h"

namespace settings {
namespace {

// value in SI = number * multiply / divide. Dividing by a power of ten rounds once: 9 ms is the double nearest to
// 0.009.
struct UnitName {
  std::string_view name;
  double multiply = 1, divide = 1;
};

constexpr double kPi = 3.14159265358979323846;
constexpr UnitName kTime[] = {{"s"}, {"ms", 1, 1e3}, {"us", 1, 1e6}, {"ns", 1, 1e9}, {"min", 60, 1}};
constexpr UnitName kLength[] = {{"m"}, {"cm", 1, 1e2}, {"mm", 1, 1e3}, {"km", 1e3, 1}};
constexpr UnitName kAngle[] = {{"rad"}, {"mrad", 1, 1e3}, {"deg", kPi, 180}};
constexpr UnitName kSpeed[] = {{"m/s"}, {"cm/s", 1, 1e2}, {"mm/s", 1, 1e3}, {"km/h", 1, 3.6}};
constexpr UnitName kAngularRate[] = {{"rad/s"}, {"deg/s", kPi, 180}};
constexpr UnitName kFrequency[] = {{"Hz"}, {"kHz", 1e3, 1}};
constexpr UnitName kRate[] = {{"1/s"}};
constexpr UnitName kPixel[] = {{"px"}};
constexpr UnitName kElectrons[] = {{"e"}};
constexpr UnitName kElectronRate[] = {{"e/s"}};
constexpr UnitName kAccelerationDensity[] = {{"m/s^1.5"}, {"cm/s^1.5", 1, 1e2}};
constexpr UnitName kAngularAccelerationDensity[] = {{"rad/s^1.5"}, {"deg/s^1.5", kPi, 180}};

struct Kind {
  std::string_view article_and_name;
  std::span<const UnitName> units;
};

constexpr Kind kKinds[] = {{"a number", {}},
                           {"a time", kTime},
                           {"a length", kLength},
                           {"an angle", kAngle},
                           {"a speed", kSpeed},
                           {"an angular rate", kAngularRate},
                           {"a frequency", kFrequency},
                           {"a rate", kRate},
                           {"a number of pixels", kPixel},
                           {"a number of electrons", kElectrons},
                           {"a current of electrons", kElectronRate},
                           {"the density of an acceleration noise", kAccelerationDensity},
                           {"the density of an angular acceleration noise", kAngularAccelerationDensity}};
static_assert(std::size(kKinds) == static_cast<std::size_t>(Unit::angular_acceleration_density) + 1);

const Kind& KindOf(Unit unit) { return kKinds[static_cast<std::size_t>(unit)]; }

// Joined piece by piece: GCC 12 warns of "literal" + std::string where it inlines it (its bug 105651).
std::string Quoted(std::string_view text) { return std::string("'").append(text).append("'"); }

std::string Expected(const Kind& kind) {
  if (kind.units.empty()) return "expected a bare number";
  std::string text = "expected a number with ";
  for (const UnitName& unit : kind.units) text += std::string(unit.name) + ", ";
  return text + "or a bare number of " + std::string(kind.units[0].name);
}

std::string_view Trim(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

bool IsNotFinite(std::string_view text) {
  if (!text.empty() && (text.front() == '-' || text.front() == '+')) text.remove_prefix(1);
  if (!text.empty() && text.front() == '.') text.remove_prefix(1);  // YAML writes .nan, .inf
  std::string word;
  for (const char c : text.substr(0, 3)) word += static_cast<char>(c | 0x20);
  return word == "nan" || word == "inf";
}

}  // namespace

std::string_view SymbolOf(Unit unit) {
  const Kind& kind = KindOf(unit);
  return kind.units.empty() ? std::string_view() : kind.units[0].name;
}

bool ParseQuantity(std::string_view text, Unit unit, const Range& range, double& value, std::string& problem) {
  const Kind& kind = KindOf(unit);
  const auto fail = [&](const std::string& what) {
    problem = Quoted(text).append(what);
    return false;
  };
  if (IsNotFinite(Trim(text))) return fail(" is not a finite number");
  const std::string_view digits = base::WithoutPlus(Trim(text));
  double number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error == std::errc::result_out_of_range) return fail(" is out of the range of numbers");
  const std::string_view suffix = Trim(digits.substr(static_cast<std::size_t>(end - digits.data())));
  const auto unit_name = std::ranges::find(kind.units, suffix, &UnitName::name);
  if (error != std::errc() || (!suffix.empty() && unit_name == kind.units.end()))
    return fail(" is not " + std::string(kind.article_and_name) + ": " + Expected(kind));
  if (!suffix.empty()) number = number * unit_name->multiply / unit_name->divide;
  if (!std::isfinite(number)) return fail(" is out of the range of numbers");
  if (!range.Holds(number)) return fail(" " + Rule(range, unit));
  value = number;
  return true;
}

bool SplitQuantity(std::string_view text, double& number, std::string& unit) {
  const std::string_view digits = base::WithoutPlus(Trim(text));
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  const std::string_view suffix = Trim(digits.substr(static_cast<std::size_t>(end - digits.data())));
  unit = suffix.empty() ? "" : " " + std::string(suffix);
  return error == std::errc() && std::isfinite(number);
}

template <class T>
bool ParseInteger(std::string_view text, const Range& range, T& value, std::string& problem) {
  const auto fail = [&](const std::string& what) {
    problem = Quoted(text).append(what);
    return false;
  };
  const std::string_view digits = base::WithoutPlus(Trim(text));
  T number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  const bool complete = end == digits.data() + digits.size() && !digits.empty();
  if (complete && error == std::errc::result_out_of_range) {
    return fail(" does not fit: expected a whole number of at most " + std::to_string(std::numeric_limits<T>::max()));
  }
  if (!complete || error != std::errc())
    return fail(std::string(" is not a whole number") + (std::numeric_limits<T>::min() == 0 ? " of at least 0" : ""));
  if (!range.Holds(static_cast<double>(number))) return fail(" " + Rule(range, Unit::none));
  value = number;
  return true;
}

template bool ParseInteger(std::string_view, const Range&, int&, std::string&);
template bool ParseInteger(std::string_view, const Range&, std::int64_t&, std::string&);
template bool ParseInteger(std::string_view, const Range&, std::uint64_t&, std::string&);

std::string FormatNumber(double value) {
  char text[32];
  const auto [end, error] = std::to_chars(text, text + sizeof text, value);
  return error == std::errc() ? std::string(text, end) : std::to_string(value);
}

}  // namespace settings
