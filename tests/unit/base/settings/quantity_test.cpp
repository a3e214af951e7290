#include "tools/base/settings/quantity.h"

#include <gmock/gmock.h>
#include <rapidcheck.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

namespace settings {
namespace {

using testing::HasSubstr;

double Value(const std::string& text, Unit unit) {
  double value = std::nan("");
  std::string problem;
  EXPECT_TRUE(ParseQuantity(text, unit, {}, value, problem)) << text << ": " << problem;
  return value;
}

std::string Problem(const std::string& text, Unit unit, const Range& range = {}) {
  double value = 1234.5;
  std::string problem;
  EXPECT_FALSE(ParseQuantity(text, unit, range, value, problem)) << text;
  EXPECT_EQ(value, 1234.5) << "a bad text leaves the value alone";
  EXPECT_THAT(problem, HasSubstr("'" + text + "'")) << "the value is named";
  return problem;
}

TEST(Quantity, EachUnitIsTheNearestDoubleOfItsValueInSi) {
  EXPECT_EQ(Value("9 ms", Unit::time), 0.009);
  EXPECT_EQ(Value("9ms", Unit::time), 0.009);
  EXPECT_EQ(Value(" 8.1 us ", Unit::time), 8.1e-6);
  EXPECT_EQ(Value("7 ns", Unit::time), 7e-9);
  EXPECT_EQ(Value("2 min", Unit::time), 120.0);
  EXPECT_EQ(Value("3 s", Unit::time), 3.0);
  EXPECT_EQ(Value("3", Unit::time), 3.0);
  EXPECT_EQ(Value("3 mm", Unit::length), 0.003);
  EXPECT_EQ(Value("3 cm", Unit::length), 0.03);
  EXPECT_EQ(Value("3 km", Unit::length), 3000.0);
  EXPECT_DOUBLE_EQ(Value("180 deg", Unit::angle), std::acos(-1.0));
  EXPECT_EQ(Value("5 mrad", Unit::angle), 0.005);
  EXPECT_DOUBLE_EQ(Value("90 deg/s", Unit::angular_rate), std::acos(-1.0) / 2);
  EXPECT_DOUBLE_EQ(Value("36 km/h", Unit::speed), 10.0);
  EXPECT_EQ(Value("36 cm/s", Unit::speed), 0.36);
  EXPECT_EQ(Value("2 kHz", Unit::frequency), 2000.0);
  EXPECT_EQ(Value("1.5 1/s", Unit::rate), 1.5);
  EXPECT_EQ(Value("2 px", Unit::pixel), 2.0);
  EXPECT_EQ(Value("20 e", Unit::electrons), 20.0);
  EXPECT_EQ(Value("20 cm/s^1.5", Unit::acceleration_density), 0.2);
  EXPECT_DOUBLE_EQ(Value("180 deg/s^1.5", Unit::angular_acceleration_density), std::acos(-1.0));
}

TEST(Quantity, NumbersAsPeopleWriteThem) {
  EXPECT_EQ(Value("+3", Unit::none), 3.0);
  EXPECT_EQ(Value("-3.5e-2", Unit::none), -0.035);
  EXPECT_EQ(Value(".5", Unit::none), 0.5);
  EXPECT_EQ(Value("1e3", Unit::none), 1000.0);
  EXPECT_EQ(Value("1e-3 s", Unit::time), 0.001);
  EXPECT_EQ(Value("2e", Unit::electrons), 2.0);
}

TEST(Quantity, WrongUnit) {
  EXPECT_EQ(Problem("8 px", Unit::time),
            "'8 px' is not a time: expected a number with s, ms, us, ns, min, or a bare number of s");
  EXPECT_EQ(Problem("8 ms", Unit::none), "'8 ms' is not a number: expected a bare number");
  EXPECT_THAT(Problem("8 m", Unit::time), HasSubstr("not a time"));
  EXPECT_THAT(Problem("8 MS", Unit::time), HasSubstr("not a time")) << "units have their case";
  EXPECT_THAT(Problem("8 rad", Unit::length), HasSubstr("not a length"));
  EXPECT_THAT(Problem("three", Unit::angle), HasSubstr("not an angle"));
  EXPECT_THAT(Problem("", Unit::angle), HasSubstr("not an angle"));
  EXPECT_THAT(Problem("ms", Unit::time), HasSubstr("not a time"));
  EXPECT_THAT(Problem("1,5 s", Unit::time), HasSubstr("not a time"));
  EXPECT_THAT(Problem("0x10", Unit::none), HasSubstr("not a number"));
  EXPECT_THAT(Problem("+-3", Unit::none), HasSubstr("not a number"));
  EXPECT_THAT(Problem("1 2", Unit::none), HasSubstr("not a number"));
}

TEST(Quantity, WhatIsNotFiniteIsRefused) {
  for (const char* text : {"nan", "NaN", ".nan", "-nan", "inf", "-inf", ".inf", "+.Inf", "Infinity", "nan ms"}) {
    EXPECT_THAT(Problem(text, Unit::time), HasSubstr("finite"));
  }
  EXPECT_THAT(Problem("1e999", Unit::none), HasSubstr("out of the range"));
  EXPECT_THAT(Problem("1e308 km", Unit::length), HasSubstr("out of the range"));
}

TEST(Quantity, RangesAreClosedAndNamed) {
  double value = 0;
  std::string problem;
  EXPECT_TRUE(ParseQuantity("0", Unit::none, {0, 1}, value, problem));
  EXPECT_TRUE(ParseQuantity("1", Unit::none, {0, 1}, value, problem));
  EXPECT_EQ(Problem("1.5", Unit::none, {0, 1}), "'1.5' must lie in 0 ... 1");
  EXPECT_EQ(Problem("20 ms", Unit::time, {0, 0.01}), "'20 ms' must lie in 0 ... 0.01 s");
  EXPECT_EQ(Problem("-1", Unit::none, Range::AtLeast(0)), "'-1' must be at least 0");
  EXPECT_EQ(Problem("0", Unit::none, Range::Positive()), "'0' must be positive");
  EXPECT_EQ(Problem("3", Unit::none, {-std::numeric_limits<double>::infinity(), 2}), "'3' must be at most 2");
}

TEST(Quantity, WholeNumbers) {
  std::string problem;
  int i = 7;
  std::uint64_t u = 7;
  EXPECT_TRUE(ParseInteger("-2147483648", {}, i, problem));
  EXPECT_EQ(i, std::numeric_limits<int>::min());
  EXPECT_FALSE(ParseInteger("2147483648", {}, i, problem));
  EXPECT_EQ(problem, "'2147483648' does not fit: expected a whole number of at most 2147483647");
  EXPECT_TRUE(ParseInteger("18446744073709551615", {}, u, problem));
  EXPECT_EQ(u, std::numeric_limits<std::uint64_t>::max());
  EXPECT_FALSE(ParseInteger("-1", {}, u, problem));
  EXPECT_EQ(problem, "'-1' is not a whole number of at least 0");
  for (const char* text : {"", "3.0", "1e3", "3 px", "three", "+", "0x3"}) {
    EXPECT_FALSE(ParseInteger(text, {}, i, problem)) << text;
    EXPECT_THAT(problem, HasSubstr("not a whole number")) << text;
  }
  EXPECT_FALSE(ParseInteger("9", {0, 8}, i, problem));
  EXPECT_EQ(problem, "'9' must lie in 0 ... 8");
}

TEST(Quantity, EveryFiniteDoubleIsReadBackAsItself) {
  EXPECT_TRUE(rc::check([](std::uint64_t bits) {
    const auto written = std::bit_cast<double>(bits);
    RC_PRE(std::isfinite(written));
    double read = std::nan("");
    std::string problem;
    RC_ASSERT(ParseQuantity(FormatNumber(written), Unit::none, {}, read, problem));
    RC_ASSERT(std::bit_cast<std::uint64_t>(read) == bits);
  }));
}

}  // namespace
}  // namespace settings
