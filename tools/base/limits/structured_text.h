// Limits of JSON texts from elsewhere: what may be given to a parser that works by recursion, so that the depth
// of its input is the stack's.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace limits {

constexpr int kDeepestJson = 100;  // of lists and objects in each other; ours go to ten

// What is wrong with a text for nlohmann-json, which copies and prints values by recursion; empty: nothing. Whether it
// is JSON at all is left to the parser.
std::string JsonProblem(std::string_view text);

// The whole number of a JSON value; none where it is no whole number, or one that Whole does not hold. nlohmann-json's
// get<int>() casts: a number too large for the type becomes another one, and a number with a point may be one that no
// cast is defined for.
template <std::integral Whole, class Json>
std::optional<Whole> WholeNumber(const Json& json) {
  if (json.is_number_unsigned()) {
    const auto number = json.template get<std::uint64_t>();
    if (std::in_range<Whole>(number)) return static_cast<Whole>(number);
  } else if (json.is_number_integer()) {
    const auto number = json.template get<std::int64_t>();
    if (std::in_range<Whole>(number)) return static_cast<Whole>(number);
  }
  return std::nullopt;
}

}  // namespace limits
