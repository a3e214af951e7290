// Numbers with units, as settings files write them: "8 ms", "20 deg", "3".
#pragma once

#include <string>
#include <string_view>

#include "tools/base/settings/fields.h"

namespace settings {

// The number in the first unit of `unit`. On failure `problem` states the text found and what is expected, as in
// "'8 px' is not a time: expected a number with s, ms, us, ns, min, or a bare number of s". Digits are read
// independently of the locale; nan, infinity, overflow and values outside `range` are rejected.
bool ParseQuantity(std::string_view text, Unit unit, const Range& range, double& value, std::string& problem);

// "8 ms" as 8 and " ms"; whether it begins with a finite number.
bool SplitQuantity(std::string_view text, double& number, std::string& unit);

// A whole number, in decimal digits with an optional sign. T: int, std::int64_t, std::uint64_t.
template <class T>
bool ParseInteger(std::string_view text, const Range& range, T& value, std::string& problem);

// The shortest decimal text that reads back as the same number.
std::string FormatNumber(double value);

}  // namespace settings
