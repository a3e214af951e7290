// Raw values for another reader, and short forms of list items.
#include <gmock/gmock.h>

#include "tools/base/settings/settings.h"

namespace settings {
namespace {

using testing::ElementsAre;
using testing::Pair;

TEST(RawYaml, GivesTheSameValuesToAnotherReader) {
  Document document =
      Document::FromText("v: [8 ms, 3, \"a 'b'\", [1, 2], {x: 1, y: [~]}]\none: 4 px\nset: {a.b: 3, c: [1]}\n", "f");
  std::vector<RawYaml> values, one;
  std::vector<std::pair<std::string, std::string>> set;
  Section root = document.root();
  EXPECT_TRUE(root.ReadRaw("v", values));
  EXPECT_TRUE(root.ReadRaw("one", one));
  EXPECT_TRUE(root.ReadRaw("set", set));
  document.ThrowIfBad();
  ASSERT_EQ(values.size(), 5u);
  EXPECT_EQ(values[0].text, "8 ms");
  EXPECT_EQ(values[3].text, "[\"1\", \"2\"]");
  EXPECT_EQ(values[4].yaml, "{\"x\": \"1\", \"y\": [null]}");
  ASSERT_EQ(one.size(), 1u);
  EXPECT_EQ(one[0].text, "4 px");
  EXPECT_THAT(set, ElementsAre(Pair("a.b", "\"3\""), Pair("c", "[\"1\"]")));
  // Raw values keep their meaning through Override.
  Document other = Document::FromText("", "g");
  other.Override("t", values[0].yaml);
  other.Override("n", values[3].yaml);
  double t = 0;
  std::vector<double> n;
  other.root().Read("t", t, Unit::time);
  other.root().Read("n", n);
  other.ThrowIfBad();
  EXPECT_EQ(t, 0.008);
  EXPECT_THAT(n, ElementsAre(1, 2));
}

// Missing values: null in the recorded JSON, invalid as a number.
TEST(RawYaml, NothingIsNullOfJson) {
  Document document = Document::FromText("values: [~, 3]\nset: {a: ~, b: }\n", "f");
  std::vector<RawYaml> values;
  std::vector<std::pair<std::string, std::string>> set;
  Section root = document.root();
  root.ReadRaw("values", values);
  root.ReadRaw("set", set);
  document.ThrowIfBad();
  EXPECT_THAT(document.Resolved(), testing::HasSubstr("[null, \"3\"]"));
  EXPECT_THAT(document.Resolved(), testing::HasSubstr("{\"a\": null, \"b\": null}"));
  Document other = Document::FromText("", "g");
  other.Override("t", values[0].yaml);
  double t = 7;
  other.root().Read("t", t);
  EXPECT_THROW(other.ThrowIfBad(), Error);
}

TEST(RawYaml, AWordStandsForASection) {
  Document document = Document::FromText("list: [one, {file: two, n: 3}]\n", "f");
  std::vector<std::string> files;
  for (Section& item : document.root().List("list", "file")) {
    std::string file;
    double n = 0;
    item.Require("file", file);
    item.Read("n", n);
    files.push_back(file);
  }
  document.ThrowIfBad();
  EXPECT_THAT(files, ElementsAre("one", "two"));
}

TEST(RawYaml, WhatIsNoSectionIsAProblem) {
  Document document = Document::FromText("set: 3\nlist: [one]\n", "f");
  std::vector<std::pair<std::string, std::string>> set;
  EXPECT_FALSE(document.root().ReadRaw("set", set));
  document.root().List("list");
  try {
    document.ThrowIfBad();
    FAIL() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.problems().size(), 2u) << error.what();
  }
}

}  // namespace
}  // namespace settings
