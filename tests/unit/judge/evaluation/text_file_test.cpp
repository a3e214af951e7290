#include "tools/judge/evaluation/text_file.h"

#include <gmock/gmock.h>

#include <limits>

#include "tests/unit/judge/evaluation/temporary_folder.h"
#include "tools/base/text.h"

namespace evaluation {
namespace {

using testing::HasSubstr;

TEST(Nanoseconds, AreThoseOfATimeThatMayBeAdded) {
  EXPECT_EQ(Nanoseconds(0.02), 20'000'000);
  EXPECT_EQ(Nanoseconds(-1e9), -1'000'000'000'000'000'000);
  for (const double seconds : {1.1e9, -1e300, double(INFINITY), double(NAN)})
    EXPECT_EQ(Nanoseconds(seconds), std::nullopt) << seconds;
}

TEST(SecondsAsRead, AreTheDoublesNearestToTheText) {
  EXPECT_EQ(SecondsAsRead(1305031102'160407123), 1305031102.160407123);
  EXPECT_EQ(SecondsAsRead(-2'500'000'000), -2.5);
  EXPECT_EQ(SecondsAsRead(5'020'000'000), 5.02);
  for (std::int64_t stamp_ns = 1'000'000'007; stamp_ns < 4'000'000'000'000'000'000; stamp_ns += stamp_ns / 7) {
    EXPECT_EQ(SecondsAsRead(stamp_ns), std::stod(base::FormatSeconds(stamp_ns))) << stamp_ns;
    EXPECT_EQ(SecondsAsRead(-stamp_ns), -SecondsAsRead(stamp_ns));
  }
}

TEST(ParseNumber, TakesFiniteNumbersOnly) {
  EXPECT_EQ(ParseNumber("-1.5e-3"), -1.5e-3);
  EXPECT_EQ(ParseNumber("+2"), 2.0);
  for (const char* text : {"", "nan", "inf", "1.2x", "1,2", "+-1", "1e999"})
    EXPECT_EQ(ParseNumber(text), std::nullopt) << text;
}

std::vector<Line> AllLines(const std::filesystem::path& file, char separator = ' ') {
  std::vector<Line> all;
  for (const Line& line : Lines(file, separator)) all.push_back(line);
  return all;
}

TEST(Lines, SplitsAndCountsColumns) {
  const TemporaryFolder folder;
  const auto lines = AllLines(folder.Write("a.txt", "# comment\n\n  1 \t two\r\n   # indented comment\n3\n"));
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0].number, 3);
  ASSERT_EQ(lines[0].tokens.size(), 2u);
  EXPECT_EQ(lines[0].tokens[1].text, "two");
  EXPECT_EQ(lines[0].tokens[1].column, 7);
  const auto csv = AllLines(folder.Write("a.csv", "a,,b,\n"), ',');
  ASSERT_EQ(csv[0].tokens.size(), 4u);
  EXPECT_EQ(csv[0].tokens[1].text, "");
  EXPECT_EQ(csv[0].tokens[2].column, 4);
}

// Buffer reuse: no token of a longer line remains in the next one.
TEST(Lines, KeepsNothingOfTheLineBefore) {
  const TemporaryFolder folder;
  const auto lines = AllLines(folder.Write("a.txt", "one two three\nfour\n\nfive six\n"));
  ASSERT_EQ(lines.size(), 3u);
  ASSERT_EQ(lines[1].tokens.size(), 1u);
  EXPECT_EQ(lines[1].tokens[0].text, "four");
  ASSERT_EQ(lines[2].tokens.size(), 2u);
  EXPECT_EQ(lines[2].tokens[1].text, "six");
  EXPECT_EQ(lines[2].number, 4);
  EXPECT_TRUE(AllLines(folder.Write("nothing.txt", "# no line\n")).empty());
}

TEST(Lines, NamesWhatCannotBeRead) {
  const TemporaryFolder folder;
  EXPECT_THROW(Lines(folder.path() / "absent"), InputError);
  EXPECT_THROW(Lines(folder.path()), InputError);
}

TEST(Problems, OrderAndPlace) {
  Problems problems;
  EXPECT_NO_THROW(problems.ThrowIfAny());
  problems.Add("a/b.txt", "is none");
  problems.Add("c.txt", 12, 3, "neither");
  try {
    problems.ThrowIfAny();
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "a/b.txt: is none\nc.txt:12:3: neither");
  }
}

TEST(InputError, CountsBeyondFifty) {
  std::string fifty = "x";
  for (int i = 1; i < 50; ++i) fifty += "\nx";
  EXPECT_EQ(InputError(std::vector<std::string>(50, "x")).what(), fifty);
  EXPECT_EQ(InputError(std::vector<std::string>(51, "x")).what(), fifty + "\n... and 1 more problems");
  const InputError error(std::vector<std::string>(70, "x"));
  EXPECT_THAT(error.what(), HasSubstr("and 20 more"));
}

}  // namespace
}  // namespace evaluation
