// Reader of a settings section by the field table of its struct (fields.h): strict, all problems at once.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "tools/base/settings/fields.h"
#include "tools/base/settings/settings.h"

namespace settings {

class FieldReader {
 public:
  // have_all: every value has a default that is meant, even of keys that must be there otherwise.
  explicit FieldReader(Section section, bool have_all = false) : section_(std::move(section)), have_all_(have_all) {}

  template <class T>
  void operator()(const char* key, T& value, const Field& field) {
    const bool given = section_.Has(key);
    if constexpr (Optional<T>) {  // not among the resolved settings unless given
      section_.Allow(key);
      typename T::value_type read{};
      if (given && Note(Read(key, read, field))) value = read;
    } else {
      Note(Read(key, value, field) || !given);
    }
  }
  template <class T>
  void operator()(const char* key, T& value, const Choices<std::type_identity_t<T>>& choices, const char*) {
    const bool given = section_.Has(key);
    if (!renamed_value_) Note(section_.ReadChoice(key, value, choices) || !given);
    renamed_value_ = false;
  }
  // A list of names.
  template <class T>
  void operator()(const char* key, std::set<T>& values, const Choices<std::type_identity_t<T>>& choices, const char*) {
    std::vector<std::string> names;
    for (const auto& [name, choice] : choices) {
      if (values.contains(choice)) names.push_back(name);
    }
    if (!section_.Read(key, names)) return static_cast<void>(Note(!section_.Has(key)));
    values.clear();
    for (const std::string& name : names) {
      const auto at = std::ranges::find(choices, name, &Choices<T>::value_type::first);
      if (Note(at != choices.end())) {
        values.insert(at->second);
      } else {
        section_.Reject(key, "'" + std::string(key) + "': there is no '" + name + "'; there are " + NamesOf(choices));
      }
    }
  }
  template <class T>
  void Required(const char* key, T& value, const Field& field) {
    (*this)(key, value, field);
    if (have_all_) return;
    section_.RequirePresent(key);
    Note(section_.Has(key));
  }
  template <class S>
  void Child(const char* key, S&& child) {
    FieldReader reader(section_.Child(key));
    if constexpr (std::invocable<S&, FieldReader&>) {
      child(reader);
    } else {
      Visit(reader, child);
    }
    Note(reader.good_);
  }
  // A key of older files, or such a value of the choice visited next: a problem that names the new one.
  void Renamed(const char* key, const char* now) { Note(!section_.Renamed(key, now)); }
  void Renamed(const char* key, const char* value, const char* now) {
    renamed_value_ = section_.Renamed(key, value, now);
    Note(!renamed_value_);
  }
  bool good() const { return good_; }

 private:
  bool Note(bool good) {
    good_ = good_ && good;
    return good;
  }
  template <class T>
  bool Read(const char* key, T& value, const Field& field) {
    if constexpr (std::same_as<T, bool>) {
      return section_.Read(key, value);
    } else if constexpr (Vector3<T>) {
      std::array<double, 3> numbers{value.x, value.y, value.z};
      const bool good = section_.Read(key, numbers, field.unit, field.range);
      value = {numbers[0], numbers[1], numbers[2]};
      return good;
    } else if constexpr (Quaternion<T>) {
      return ReadQuaternion(key, value);
    } else if constexpr (std::integral<T>) {
      return section_.Read(key, value, field.range);
    } else {
      return section_.Read(key, value, field.unit, field.range);
    }
  }
  // x, y, z, w; the length is 1 within 1e-3, and is made so by the quaternion's own functions.
  template <class Q>
  bool ReadQuaternion(const char* key, Q& value) {
    std::array<double, 4> numbers{value.x, value.y, value.z, value.w};
    if (!section_.Read(key, numbers, Unit::none, Range{-1.001, 1.001})) return false;
    Q q = value;
    q.x = numbers[0], q.y = numbers[1], q.z = numbers[2], q.w = numbers[3];
    const bool good = std::abs(length(q) - 1) <= 1e-3;
    if (good) value = normalize(q);
    if (!good) {
      section_.Reject(key, "'" + std::string(key) + "': the quaternion's length is " + FormatNumber(length(q)) +
                               ", not 1 (x, y, z, w)");
    }
    return good;
  }

  Section section_;
  bool have_all_;
  bool good_ = true, renamed_value_ = false;
};

// Reads all fields of a struct; whether all given values are valid.
template <class S>
bool ReadFields(const Section& section, S& values) {
  FieldReader reader(section);
  Visit(reader, values);
  return reader.good();
}

}  // namespace settings
