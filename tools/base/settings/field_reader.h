// Reader of a settings section by the field table of its struct (fields.h): strict, all problems at once.
#pragma once

#include <array>
#include <concepts>
#include <type_traits>
#include <utility>

#include "tools/base/settings/fields.h"
#include "tools/base/settings/settings.h"

namespace settings {

class FieldReader {
 public:
  explicit FieldReader(Section section) : section_(std::move(section)) {}

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
  // A key of older files, or a value of the choice that is visited next: a problem that names the new one.
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
    } else if constexpr (std::integral<T>) {
      return section_.Read(key, value, field.range);
    } else {
      return section_.Read(key, value, field.unit, field.range);
    }
  }

  Section section_;
  bool good_ = true, renamed_value_ = false;
};

// Whether all that was there is good.
template <class S>
bool ReadFields(const Section& section, S& values) {
  FieldReader reader(section);
  Visit(reader, values);
  return reader.good();
}

}  // namespace settings
