#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "tools/base/limits/structured_text.h"

namespace limits {
namespace {

template <class Whole>
std::optional<Whole> Of(const char* text) {
  return WholeNumber<Whole>(nlohmann::json::parse(text));
}

TEST(WholeNumber, IsTheNumberOrNothing) {
  EXPECT_EQ(Of<int>("-7"), -7);
  EXPECT_EQ(Of<int>("2147483647"), 2147483647);
  EXPECT_EQ(Of<int>("2147483648"), std::nullopt);
  EXPECT_EQ(Of<int>("-2147483649"), std::nullopt);
  EXPECT_EQ(Of<std::int64_t>("-9223372036854775808"), std::numeric_limits<std::int64_t>::min());
  EXPECT_EQ(Of<std::int64_t>("9223372036854775808"), std::nullopt);
  EXPECT_EQ(Of<std::uint64_t>("18446744073709551615"), std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(Of<std::uint64_t>("18446744073709551616"), std::nullopt) << "nlohmann-json makes a double of it";
  EXPECT_EQ(Of<std::uint64_t>("-1"), std::nullopt);
  for (const char* text : {"1.0", "1e3", "4e97", "\"1\"", "true", "null", "[1]"})
    EXPECT_EQ(Of<int>(text), std::nullopt) << text;
}

}  // namespace
}  // namespace limits
