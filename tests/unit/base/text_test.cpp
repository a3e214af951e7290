#include "tools/base/text.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

namespace base {
namespace {

TEST(Join, PutsTheSeparatorBetween) {
  EXPECT_EQ(Join({}, ", "), "");
  EXPECT_EQ(Join({"a"}, ", "), "a");
  EXPECT_EQ(Join({"", "b", ""}, ", "), ", b, ");
}

TEST(ParseWhole, TakesAllOfTheTextOrNothing) {
  EXPECT_EQ(ParseWhole("-12"), -12);
  EXPECT_EQ(ParseWhole("9223372036854775807"), 9223372036854775807);
  for (const char* text : {"", "9223372036854775808", "1.5", "1 ", " 1", "x", "+1"})
    EXPECT_EQ(ParseWhole(text), std::nullopt) << text;
}

TEST(SplitWords, BetweenBlanksTabsCommasAndSemicolons) {
  const std::vector<Word> words = SplitWords(" 1.5,\t2; 3 ,4\r");
  ASSERT_EQ(words.size(), 4u);
  EXPECT_EQ(words[0].text, "1.5");
  EXPECT_EQ(words[0].column, 2);
  EXPECT_EQ(words[3].text, "4");
  EXPECT_EQ(words[3].column, 13);
  EXPECT_TRUE(SplitWords(" ,;\t").empty());
}

TEST(WithoutMark, LeavesOutOneMark) {
  EXPECT_EQ(WithoutMark("\xef\xbb\xbf# a"), "# a");
  EXPECT_EQ(WithoutMark("# \xef\xbb\xbf"), "# \xef\xbb\xbf");
}

TEST(TextProblem, OfWhatIsNoTextInLines) {
  for (const char* text : {"", "# a", "1 2\r", "1\r\n2\r\n", "1\n2\x1a", "\xef\xbb\xbf\xc3\xbc\t"})
    EXPECT_EQ(TextProblem(text), "");
  EXPECT_EQ(TextProblem(std::string_view("\xff\xfe#\0", 4)), "is a text in UTF-16: save it in UTF-8");
  EXPECT_EQ(TextProblem(std::string_view("\xfe\xff\0#", 4)), "is a text in UTF-16: save it in UTF-8");
  for (const std::string_view bytes : {std::string_view("a\0b", 3), std::string_view("\x1f\x8b\x08")})
    EXPECT_NE(TextProblem(bytes), "");
  EXPECT_EQ(TextProblem("1 2\r3 4\r"), "has lines that end in CR alone: save it with LF");
}

TEST(UnitOfStamp, NamesWhatAStampOfTheseYearsCounts) {
  EXPECT_EQ(UnitOfStamp("4000000000"), "");
  EXPECT_NE(UnitOfStamp("1403636579763.5").find("milliseconds: divide the times by 1e3"), std::string::npos);
  EXPECT_NE(UnitOfStamp("1403636579763555").find("microseconds: divide the times by 1e6"), std::string::npos);
  EXPECT_NE(UnitOfStamp("1.403636579763555584e+18").find("nanoseconds: divide the times by 1e9"), std::string::npos);
  EXPECT_EQ(UnitOfStamp("4000000001"), ", 4e9 at most");
  EXPECT_EQ(UnitOfStamp("word"), "");
}

TEST(Fixed, HasAllDigitsOfTheLongestDouble) {
  EXPECT_EQ(Fixed(2. / 3, 3), "0.667");
  EXPECT_EQ(Fixed(-std::numeric_limits<double>::max(), 6).size(), 1u + 309 + 1 + 6);
}

TEST(ParseSeconds, IsExactWhereADoubleIsNot) {
  EXPECT_EQ(ParseSeconds("1305031102.160407123"), 1305031102'160407123);
  EXPECT_EQ(ParseSeconds("1305031102.1604"), 1305031102'160400000);
  EXPECT_EQ(ParseSeconds("0.033333333"), 33333333);
  EXPECT_EQ(ParseSeconds("1.305031102160407066e+09"), 1305031102'160407066);
  EXPECT_EQ(ParseSeconds("5e-10"), 1);  // rounded
  EXPECT_EQ(ParseSeconds("4e-10"), 0);
  EXPECT_EQ(ParseSeconds("1e-100"), 0);
  EXPECT_FALSE(ParseSeconds("1e-101"));
  EXPECT_EQ(ParseSeconds("0e100"), 0);
  EXPECT_FALSE(ParseSeconds("0e101"));
  EXPECT_EQ(ParseSeconds("9e-11"), 0);
  EXPECT_EQ(ParseSeconds("1.00000000049"), 1'000'000'000);
  EXPECT_EQ(ParseSeconds("1.0000000005"), 1'000'000'001);
  EXPECT_EQ(ParseSeconds("2E1"), 20'000'000'000);
  EXPECT_EQ(ParseSeconds("+2e+1"), 20'000'000'000);
  EXPECT_EQ(ParseSeconds("0.00e3"), 0);
  EXPECT_FALSE(ParseSeconds("1e10"));
  EXPECT_EQ(ParseSeconds("-1.5"), -1'500'000'000);
  EXPECT_EQ(ParseSeconds("7"), 7'000'000'000);
  EXPECT_EQ(ParseSeconds("000000000000000000001.5"), 1'500'000'000);
  EXPECT_EQ(ParseSeconds("-3999999999.999999999"), -3999999999'999999999);
}

// Range of stamps: sums and differences of two stamps, and of a stamp and a gap, fit.
TEST(ParseSeconds, EndsAtFourBillionSeconds) {
  EXPECT_EQ(ParseSeconds("4e9"), kLatest_ns);
  EXPECT_EQ(ParseSeconds("-4e9"), -kLatest_ns);
  for (const char* text :
       {"4000000000.000000001", "-4000000000.000000001", "9223372036.854775807", "18446744073.709551617"})
    EXPECT_EQ(ParseSeconds(text), std::nullopt) << text;
}

TEST(ParseSeconds, RejectsWhatIsNoTime) {
  for (const char* text :
       {"", ".", "-", "nan", "1.2.3", "1s", "1e", "1e+", "0x10", "1 ", "9223372036.854775808", "1e300"}) {
    EXPECT_EQ(ParseSeconds(text), std::nullopt) << text;
  }
}

TEST(FormatSeconds, IsTheInverse) {
  for (const std::int64_t t : {0L, 1L, 999'999'999L, 1305031102'160407123L, -1'500'000'000L, -1L}) {
    EXPECT_EQ(ParseSeconds(FormatSeconds(t)), t);
  }
  EXPECT_EQ(FormatSeconds(0), "0.000000000");
  EXPECT_EQ(FormatSeconds(33333333), "0.033333333");
  EXPECT_EQ(FormatSeconds(-12'000'000'034), "-12.000000034");
  EXPECT_EQ(FormatSeconds(std::numeric_limits<std::int64_t>::min()), "-9223372036.854775808");
}

TEST(Significant, HasAsManyDigitsAsAreAskedFor) {
  EXPECT_EQ(Significant(2. / 3, 3), "0.667");
  EXPECT_EQ(Significant(2. / 3, 12), "0.666666666667");
}

}  // namespace
}  // namespace base
