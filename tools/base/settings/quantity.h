// Purpose: numbers with units, as settings files write them: "8 ms", "20 deg", "3".
#pragma once

#include <limits>
#include <string>
#include <string_view>

namespace settings {

// What a number measures. A bare number is in the first unit named.
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

// Both ends belong to the range.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();

  static Range Positive() {
    return {std::numeric_limits<double>::denorm_min(), std::numeric_limits<double>::infinity()};
  }
  static Range AtLeast(double min) { return {min, std::numeric_limits<double>::infinity()}; }
};

// The number in the first unit of `unit`. On failure `problem` says what was found and what is expected, as in
// "'8 px' is not a time: expected a number with s, ms, us, ns, min, or a bare number of s". Digits are read
// independently of the locale; nan, infinity and what overflows are refused; so is what is outside `range`.
bool ParseQuantity(std::string_view text, Unit unit, const Range& range, double& value, std::string& problem);

// A whole number, in decimal digits with an optional sign. T: int, std::int64_t, std::uint64_t.
template <class T>
bool ParseInteger(std::string_view text, const Range& range, T& value, std::string& problem);

// The shortest decimal text that reads back as the same number.
std::string FormatNumber(double value);

}  // namespace settings
