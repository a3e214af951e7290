// Field table of a struct of settings: key, unit, range and a line of help of each member, once, beside the struct.
//
//   template <class V>
//   void Visit(V& v, MotionParams& p) {
//     v("position_noise", p.position_noise, {Unit::acceleration_density, Range::Positive(), "of the acceleration"});
//   }
//
// Visitors use it: FieldCheck tests the ranges, FieldRows lists the rows for documentation and help, FieldReader
// (field_reader.h) reads a settings file. The defaults are those of the struct. Standard library only.
#pragma once

#include <concepts>
#include <limits>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace settings {

// Physical dimension of a number. A bare number is in the first unit named.
enum class Unit {
  none,                          // a bare number only
  time,                          // s, ms, us, ns, min
  length,                        // m, cm, mm, km
  angle,                         // rad, mrad, deg
  speed,                         // m/s, cm/s, mm/s, km/h
  angular_rate,                  // rad/s, deg/s
  frequency,                     // Hz, kHz
  rate,                          // 1/s
  pixel,                         // px
  electrons,                     // e
  electron_rate,                 // e/s
  acceleration_density,          // m/s^1.5, cm/s^1.5: square root of the power spectral density of white acceleration
  angular_acceleration_density,  // rad/s^1.5, deg/s^1.5
};
std::string_view SymbolOf(Unit unit);  // the first unit named; empty for none

struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool above_min = false, below_max = false;  // the end itself does not belong to the range
  enum class Kind { any, odd, power_of_two } kind = Kind::any;

  static Range AtLeast(double min) { return {.min = min}; }
  static Range Positive() { return {.min = 0, .above_min = true}; }
  static Range Between(double min, double max) { return {min, max, true, true}; }  // both ends excluded
  static Range OddAtLeast(double min) { return {.min = min, .kind = Kind::odd}; }
  static Range PowerOfTwo(double max) { return {.min = 1, .max = max, .kind = Kind::power_of_two}; }

  bool Holds(double value) const;  // false for non-finite values
};
// "positive", "at least 3 s", "0 ... 1", "above 0 and at most 1", "odd and at least 1"; empty without a bound.
std::string Describe(const Range& range, Unit unit);
// "must be positive", "must lie in 0 ... 1".
std::string Rule(const Range& range, Unit unit);

struct Field {
  Field(const char* text) : help(text) {}
  Field(Range bounds, const char* text) : range(bounds), help(text) {}
  Field(Unit measure, const char* text) : unit(measure), help(text) {}
  Field(Unit measure, Range bounds, const char* text) : unit(measure), range(bounds), help(text) {}

  Unit unit = Unit::none;
  Range range;
  const char* help;
};

template <class T>
using Choices = std::vector<std::pair<std::string, T>>;
// "a, b, c".
template <class T>
std::string NamesOf(const Choices<T>& choices) {
  std::string names;
  for (const auto& [name, choice] : choices) names += (names.empty() ? "" : ", ") + name;
  return names;
}

template <class T>
concept Vector3 = requires(T t) {
  t.x, t.y, t.z;
}
&&!requires(T t) { t.w; };
template <class T>
concept Quaternion = requires(T t) {
  t.x, t.y, t.z, t.w;
};
template <class T>
concept Optional = requires(T t) {
  t.has_value();
};
template <class T>
concept Numeric = std::is_arithmetic_v<T> && !std::same_as<T, bool>;

// Base of the visitors: a section is a struct with a field table, or a function that visits some fields.
template <class V>
class FieldVisitor {
 public:
  template <class S>
  void Child(const char* key, S&& child) {
    const std::string outer = prefix_;
    prefix_ += std::string(key) + ".";
    if constexpr (std::invocable<S&, V&>) {
      child(static_cast<V&>(*this));
    } else {
      Visit(static_cast<V&>(*this), child);
    }
    prefix_ = outer;
  }
  // A required field.
  template <class T>
  void Required(const char* key, T& value, const Field& field) {
    static_cast<V&> (*this)(key, value, field);
  }
  // A key, or a value of the next choice, of older files: for the reader.
  void Renamed(const char*, const char*) {}
  void Renamed(const char*, const char*, const char*) {}

 protected:
  std::string prefix_;
};

// A violated rule: dotted key, and message, "= 8 must be odd and at least 1".
struct FieldProblem {
  std::string key, message;
};
// The sentences "key message".
std::string Join(const std::vector<FieldProblem>& problems, const std::string& separator);
// Throws std::invalid_argument("subject: sentence; sentence") if there are any problems.
void ThrowIfAny(const std::vector<FieldProblem>& problems, const std::string& subject);

// Problems of a struct: first the ranges of its table (FieldCheck check; Visit(check, params)), then its rules between
// several values by Require and Refuse.
class FieldCheck : public FieldVisitor<FieldCheck> {
 public:
  template <class T>
  void operator()(const char* key, T& value, const Field& field) {
    if constexpr (Optional<T>) {
      if (value) (*this)(key, *value, field);
    } else if constexpr (Vector3<T>) {
      for (const double x : {value.x, value.y, value.z}) Check(key, x, field);
    } else if constexpr (Numeric<T>) {
      Check(key, static_cast<double>(value), field);
    }
  }
  template <class T>
  void operator()(const char*, T&, const Choices<std::type_identity_t<T>>&, const char*) {}
  template <class T>
  void operator()(const char*, std::set<T>&, const Choices<std::type_identity_t<T>>&, const char*) {}

  // Adds "= value rule" unless `ok`.
  void Require(bool ok, const std::string& key, double value, const std::string& rule);
  void Refuse(const std::string& key, const std::string& message) { problems.push_back({key, message}); }

  std::vector<FieldProblem> problems;

 private:
  void Check(const char* key, double value, const Field& field);
};

// A line of a table of settings: dotted key, default with its unit, range or choices, help.
struct FieldRow {
  std::string key, value, range, help;
};

class FieldRows : public FieldVisitor<FieldRows> {
 public:
  template <class T>
  void operator()(const char* key, T& value, const Field& field) {
    const std::string range = Describe(field.range, field.unit);
    if constexpr (Optional<T>) {
      Add(key, "none", range, field.help);
    } else if constexpr (Vector3<T>) {
      const std::string xy = Text(value.x, Unit::none) + ", " + Text(value.y, Unit::none);
      Add(key, xy + ", " + Text(value.z, field.unit), range, field.help);
    } else if constexpr (Quaternion<T>) {
      Add(key, "0, 0, 0, 1", "length 1", field.help);
    } else if constexpr (Numeric<T>) {
      Add(key, Text(static_cast<double>(value), field.unit), range, field.help);
    } else {
      Add(key, value ? "true" : "false", "true, false", field.help);
    }
  }
  template <class T>
  void operator()(const char* key, T& value, const Choices<std::type_identity_t<T>>& choices, const char* help) {
    (*this)(key, std::set<T>{value}, choices, help);
  }
  template <class T>
  void operator()(const char* key, const std::set<T>& values, const Choices<std::type_identity_t<T>>& choices,
                  const char* help) {
    Choices<T> chosen;
    for (const auto& choice : choices) {
      if (values.contains(choice.second)) chosen.push_back(choice);
    }
    Add(key, NamesOf(chosen), NamesOf(choices), help);
  }

  std::vector<FieldRow> rows;

 private:
  static std::string Text(double value, Unit unit);
  // No effect where the key has a row: a table may be visited once for each variant of its struct.
  void Add(const char* key, const std::string& value, const std::string& range, const char* help);
};

}  // namespace settings
