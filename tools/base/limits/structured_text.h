// Limits of untrusted JSON texts for a parser that works by recursion, where the depth of the input is that of the
// stack.
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

// Problem of a text for nlohmann-json, which copies and prints values by recursion; empty: none. Whether it is valid
// JSON is left to the parser.
std::string JsonProblem(std::string_view text);

// The whole number of a JSON value; none where it is not a whole number or does not fit into Whole. nlohmann-json's
// get<int>() casts: a number too large for the type wraps, and the cast of a number with a point may be undefined.
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
