// Table of options: --help fits a terminal, its defaults are the structs', and its examples are commands.
#include "tools/vobench/option_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "tools/vobench/arguments.h"
#include "tools/vobench/help_text.h"

namespace vobench {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::vector<std::string> Lines(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::variant<Command, int> Parse(std::vector<std::string> words) {
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  return ParseArguments(static_cast<int>(argv.size()), argv.data());
}

TEST(Help, FitsATerminalAndHasAnExample) {
  const OptionTable table;
  std::vector<const CLI::App*> all = CommandsOf(table.app);
  ASSERT_EQ(all.size(), std::variant_size_v<Command>);
  all.push_back(&table.app);
  for (const CLI::App* command : all) {
    const std::string help = command->help();
    EXPECT_LE(Lines(help).size(), 24u) << help;
    for (const std::string& line : Lines(help)) EXPECT_LE(line.size(), 100u) << line;
    if (command != &table.app) {
      EXPECT_THAT(help, HasSubstr("\nExample: vobench " + command->get_name() + " "));
    }
    for (const OptionRow& row : RowsOf(*command)) {
      EXPECT_THAT(help, HasSubstr("\n  " + row.Synopsis() + "  "));
    }
  }
}

TEST(Help, HasTheDefaultsOfTheStructs) {
  const OptionTable table;
  const auto text = [&](const std::string& command, const std::string& option) {
    for (const OptionRow& row : RowsOf(*table.app.get_subcommand(command))) {
      if (row.names.back() == option) return row.text;
    }
    throw std::out_of_range(command + " " + option);
  };
  EXPECT_THAT(text("render", "--format"), HasSubstr(" [" + RenderOptions().format + "]"));
  EXPECT_THAT(text("track", "--system"), HasSubstr(" [" + TrackOptions().system + "]"));
  EXPECT_THAT(text("track", "--seed"), HasSubstr(" [" + std::to_string(TrackOptions().seed) + "]"));
  EXPECT_THAT(text("evaluate", "--align"), HasSubstr(" [" + EvaluateOptions().align + "]"));
  EXPECT_THAT(text("run", "--system"), HasSubstr(" [" + RunOptions().systems.front() + "]"));
  EXPECT_THAT(text("run", "--runs"), HasSubstr(" [" + std::to_string(RunOptions().runs) + "]"));
  EXPECT_THAT(text("run", "--seed"), HasSubstr(" [" + std::to_string(RunOptions().seed) + "]"));
  EXPECT_THAT(text("campaign", "--engine"), HasSubstr(" [" + CampaignOptions().engine + "]"));
  EXPECT_THAT(text("campaign", "--tasks-per-job"),
              HasSubstr(" [" + std::to_string(CampaignOptions().tasks_per_job) + "]"));
  EXPECT_THAT(text("campaign", "--output"), HasSubstr("(required)"));
  EXPECT_THAT(text("render", "--frames"), Not(HasSubstr("[")));
}

TEST(Help, HasExamplesThatAreCommands) {
  const OptionTable table;
  for (const CLI::App* command : CommandsOf(table.app)) {
    const std::string footer = command->get_footer();
    std::vector<std::string> words{""};
    bool quoted = false;  // as a shell reads it
    for (const char c : footer.substr(footer.find(": ") + 2)) {
      if (c == '\'')
        quoted = !quoted;
      else if (c == ' ' && !quoted)
        words.emplace_back();
      else
        words.back() += c;
    }
    EXPECT_TRUE(std::holds_alternative<Command>(Parse(words))) << footer;
  }
}

TEST(ParseArguments, ReadsWhatTheTableHas) {
  const auto parsed = Parse({"vobench", "run", "a.yaml", "--system", "rbpf,rb2pf", "--seed", "7", "-j", "3", "--engine",
                             "rasteriser", "--set", "a.b=c d", "--require-consistent"});
  const RunOptions& run = std::get<RunOptions>(std::get<Command>(parsed));
  EXPECT_EQ(run.systems, (std::vector<std::string>{"rbpf", "rb2pf"}));
  EXPECT_EQ(run.seed, 7u);
  EXPECT_EQ(run.jobs, 3);
  EXPECT_TRUE(run.verdict);
  EXPECT_EQ(run.overrides, (Overrides{{"render.engine", "rasteriser"}, {"a.b", "c d"}}));
  EXPECT_THAT(run.command_line, HasSubstr("--set 'a.b=c d'"));
  const auto rendered = Parse({"vobench", "render", "a.yaml", "-o", "s", "--frames", "3:5"});
  const RenderOptions& render = std::get<RenderOptions>(std::get<Command>(rendered));
  EXPECT_EQ(render.frames, (std::pair<std::int64_t, std::int64_t>(3, 5)));
  EXPECT_FALSE(render.seed.has_value());
  EXPECT_EQ(std::get<int>(Parse({"vobench", "render", "a.yaml", "-o", "s", "--frames", "5:3"})), 2);
  EXPECT_EQ(std::get<int>(Parse({"vobench", "run", "a.yaml", "--jobs", "0"})), 2);
  EXPECT_EQ(std::get<int>(Parse({"vobench", "run", "a.yaml", "--seed", "-1"})), 2);
  EXPECT_EQ(std::get<int>(Parse({"vobench", "run", "a.yaml", "--system", "rbpf,rbpf"})), 2);
  EXPECT_EQ(std::get<int>(Parse({"vobench", "campaign", "a.yaml", "-o", "b", "--memory", "lots"})), 2);
}

}  // namespace
}  // namespace vobench
