// Purpose: a whole number of a JSON text. nlohmann-json's get<int>() casts: a number too large for the type becomes another one, and a
// number with a point may be one that no cast is defined for.
#pragma once

#include <concepts>
#include <cstdint>
#include <optional>
#include <utility>

namespace limits {

// Nothing where `json` is no whole number, or one that Whole does not hold.
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
