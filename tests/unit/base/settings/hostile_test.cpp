// Arbitrary bytes: reading a file ends with values or with settings::Error.
#include <gmock/gmock.h>
#include <rapidcheck.h>

#include <string>

#include "tools/base/settings/settings.h"

namespace settings {
namespace {

using testing::HasSubstr;

std::string Message(const std::string& text) {
  try {
    Document document = Document::FromText(text, "f.yaml");
    double value = 0;
    document.root().Read("a", value, Unit::length);
    document.root().Child("b").Read("c", value);
    for (Section& item : document.root().List("d")) item.Read("e", value);
    document.ThrowIfBad();
  } catch (const Error& error) {
    EXPECT_FALSE(error.problems().empty());
    return error.what();
  }
  return "";
}

TEST(Hostile, MalformedFilesEachWithOneClearProblem) {
  EXPECT_EQ(Message("a: [1,\nb: }"), "f.yaml:2:4: not valid YAML: illegal flow end");
  EXPECT_EQ(Message("- 1\n- 2\n"), "f.yaml:1:1: expected keys with values, not a list");
  EXPECT_EQ(Message("just a text"), "f.yaml:1:1: expected keys with values, not 'just a text'");
  EXPECT_EQ(Message("a: 1\n---\na: 2\n"), "f.yaml: holds more than one YAML document");
  EXPECT_EQ(Message("a: &x 1\n"), "") << "an anchor that is not used does no harm";
  EXPECT_EQ(Message("a: !!float 1\n"), "f.yaml:1:4: tags (tag:yaml.org,2002:float) are not supported");
  EXPECT_EQ(Message("a: 1\n? [x]\n: 2\n"), "f.yaml:2:3: a key must be a plain word, not a list");
}

TEST(Hostile, AliasesAreNotExpanded) {
  std::string bomb = "l0: &l0 [lol]\n";
  for (int i = 1; i < 40; ++i) {
    const std::string last = "*l" + std::to_string(i - 1);
    bomb += "l" + std::to_string(i) + ": &l" + std::to_string(i) + " [" + last + ", " + last + "]\n";
  }
  EXPECT_THAT(Message(bomb + "a: 1\n"), HasSubstr("f.yaml:2:10: aliases (*name) are not supported"));
}

TEST(Hostile, DeepNestingAndLongKeys) {
  EXPECT_THAT(Message(std::string(100000, '[')), HasSubstr("nested too deeply"));
  EXPECT_THAT(Message("a: " + std::string(100000, '{')), HasSubstr("nested too deeply"));
  EXPECT_THAT(Message(std::string(1000, 'k') + ": 1\n"), HasSubstr("unknown key"));
}

TEST(Hostile, RandomBytesEndInValuesOrAnError) {
  EXPECT_TRUE(rc::check([](const std::string& text) { Message(text); }));
}

TEST(Hostile, RandomPiecesOfYamlEndInValuesOrAnError) {
  EXPECT_TRUE(rc::check([] {
    const auto piece = rc::gen::element<std::string>(
        "a", "b", "c", "d", "e", ": ", ":", "\n", "\n  ", "- ", "[", "]", "{", "}", ", ", "1", "8 px", "nan", "&x ",
        "*x", "!t ", "'", "\"", "#", "---\n", "|\n", "? ", "~", "\t", std::string(1, '\0'), "\xff", "%");
    for (const auto& parts : *rc::gen::container<std::vector<std::vector<std::string>>>(
             100, rc::gen::container<std::vector<std::string>>(20, piece))) {
      std::string text;
      for (const std::string& part : parts) text += part;
      Message(text);
    }
  }));
}

}  // namespace
}  // namespace settings
