// Documentation: its commands work, its links have targets, the names in it exist.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <regex>
#include <sstream>

#include "tests/system/doc_page.h"
#include "tests/system/program.h"

namespace vobench::system_test {
namespace {
namespace fs = std::filesystem;

std::string NameOf(const testing::TestParamInfo<std::string>& page) {
  std::string name = fs::path(page.param).stem().string();
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

class DocsTest : public testing::TestWithParam<std::string> {};

TEST_P(DocsTest, EveryCommandWorks) {
  const DocPage page = ReadPage(GetParam());
  EXPECT_THAT(page.problems, testing::IsEmpty());
  if (page.has_commands) {
    EXPECT_EQ(WhatFails(page, Speed::quick), "");
  }
}

TEST_P(DocsTest, EveryLinkLeadsSomewhere) {
  const DocPage page = ReadPage(GetParam());
  for (const std::string& link : page.links) {
    if (link.starts_with("http")) continue;
    const std::size_t hash = link.find('#');
    const std::string file = link.substr(0, hash), anchor = hash == std::string::npos ? "" : link.substr(hash + 1);
    const fs::path target = file.empty() ? fs::path(page.name) : fs::path(page.name).parent_path() / file;
    EXPECT_TRUE(fs::exists(ProjectRoot() / target)) << link;
    if (anchor.empty() || target.extension() != ".md" || !fs::exists(ProjectRoot() / target)) continue;
    EXPECT_THAT(ReadPage(target.lexically_normal().string()).anchors, testing::Contains(anchor)) << link;
  }
}

INSTANTIATE_TEST_SUITE_P(All, DocsTest, testing::ValuesIn(PageNames()), NameOf);

TEST(DocPage, CommandsThatFailOrAreForgottenAreSeen) {
  const DocPage fails = ParsePage("a page", "Try\n\n    vobench check nowhere.yaml\n    vobench --version\n");
  ASSERT_TRUE(fails.has_commands);
  EXPECT_THAT(WhatFails(fails, Speed::quick), testing::HasSubstr("nowhere.yaml"));
  const DocPage works =
      ParsePage("a page", "Try\n\n<!-- file: x.txt -->\n\n    a\n\n```\ngrep -q a x.txt\nvobench --version\n```\n");
  EXPECT_EQ(WhatFails(works, Speed::quick), "");
  EXPECT_THAT(ParsePage("a page", "Try\n\n    tools/build release\n").problems, testing::SizeIs(1));
  EXPECT_THAT(ParsePage("a page", "<!-- not run: it builds -->\n\n    tools/build release\n").problems,
              testing::IsEmpty());
  EXPECT_THAT(ParsePage("a page", "<!-- notrun -->\n\n    vobench fly\n").problems, testing::SizeIs(1));
}

// Control for ParsePage: it finds the commands of real pages.
TEST(DocPage, SeesTheCommandsOfThePagesThatHaveSome) {
  const DocPage scene = ReadPage("docs/your_scene.md");
  EXPECT_THAT(scene.quick_script, testing::HasSubstr("cat > 'mine.yaml' <<'END_OF_FILE'\nworld:\n  meshes: ["));
  EXPECT_THAT(scene.quick_script, testing::HasSubstr("vobench check mine.yaml\n"));
  EXPECT_THAT(ReadPage("docs/consistency.md").quick_script, testing::Not(testing::HasSubstr("--verdict")));
  EXPECT_THAT(ReadPage("docs/consistency.md").whole_script, testing::HasSubstr("--verdict"));
  EXPECT_THAT(ReadPage("docs/metrics.md").anchors, testing::Contains("other-tools-numbers"));
}

TEST(DocPage, SettingsAreThoseOfTheProgram) {
  const std::string page = ReadFile(ProjectRoot() / "docs/settings.md");
  EXPECT_EQ(page.substr(page.find("\n## ")), RunVobench({"settings", "--markdown"}, ProjectRoot()).out)
      << "the page's tables are the output of `vobench settings --markdown`";
}

std::vector<std::string> Rows(const std::string& page) {
  std::vector<std::string> rows;
  std::istringstream lines(ReadFile(ProjectRoot() / page));
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("| ") && !line.starts_with("| equation") && !line.starts_with("| symptom"))
      rows.push_back(line);
  }
  return rows;
}

// "`name` in `file`": the file contains the name. "`file`" alone: it exists.
TEST(Equations, FunctionsAndTestsExist) {
  const std::regex named("((?:`[A-Za-z_:.]+`, )*`[A-Za-z_:.]+`) in `([a-z_/0-9]+\\.[a-zA-Z]+)`"), word("`([^`]+)`");
  int names = 0;
  for (const std::string& row : Rows("docs/algorithm.md")) {
    for (std::sregex_iterator at(row.begin(), row.end(), named), end; at != end; ++at) {
      const std::string file = (*at)[2], list = (*at)[1];
      ASSERT_TRUE(fs::exists(ProjectRoot() / file)) << file;
      const std::string text = ReadFile(ProjectRoot() / file);
      for (std::sregex_iterator name(list.begin(), list.end(), word); name != end; ++name, ++names) {
        const std::string full = (*name)[1],
                          last = full.substr(full.rfind(':') == std::string::npos ? 0 : full.rfind(':') + 1);
        EXPECT_NE(text.find(last), std::string::npos) << full << " in " << file;
      }
    }
    for (std::sregex_iterator at(row.begin(), row.end(), word), end; at != end; ++at) {
      const std::string text = (*at)[1];
      if (text.find('/') == std::string::npos) continue;
      EXPECT_TRUE(fs::exists(ProjectRoot() / text)) << text;
    }
  }
  EXPECT_GT(names, 20);
}

// All sources in one text, adjacent string literals joined.
std::string Sources() {
  std::string all;
  for (const char* folder : {"sim", "vo", "tools"}) {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(ProjectRoot() / folder)) {
      if (entry.is_regular_file() && entry.path().string().find("/web/") == std::string::npos)
        all += ReadFile(entry.path());
    }
  }
  std::string joined;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i] == '"') {
      const std::size_t next = all.find_first_not_of(" \n", i + 1);
      if (next != std::string::npos && next > i + 1 && all[next] == '"') {
        i = next;
        continue;
      }
    }
    joined += all[i];
  }
  return joined;
}

TEST(Troubleshooting, QuotesWhatTheProgramSays) {
  const std::string sources = Sources();
  const std::regex quoted("`([^`]+)`");
  int quotes = 0;
  for (const std::string& row : Rows("docs/troubleshooting.md")) {
    const std::string symptom = row.substr(0, row.find(" | "));
    for (std::sregex_iterator at(symptom.begin(), symptom.end(), quoted), end; at != end; ++at, ++quotes) {
      EXPECT_NE(sources.find((*at)[1]), std::string::npos) << "nothing says '" << (*at)[1] << "'";
    }
  }
  EXPECT_GE(quotes, 8);
}

}  // namespace
}  // namespace vobench::system_test
