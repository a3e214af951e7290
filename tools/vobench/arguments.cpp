#include "tools/vobench/arguments.h"

#include <iostream>
#include <set>
#include <sstream>

#include "tools/vobench/option_table.h"

namespace vobench {
namespace {

// "key=value"
std::pair<std::string, std::string> ParseOverride(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == 0 || equals == std::string::npos) {
    throw CLI::ValidationError("--set", "'" + text + "' is not key=value");
  }
  return {text.substr(0, equals), text.substr(equals + 1)};
}

// "A:B": the frames A, A+1, ..., B-1
std::pair<std::int64_t, std::int64_t> ParseFrames(const std::string& text) {
  std::istringstream stream(text);
  std::int64_t first = 0, last = 0;
  char colon = 0, rest = 0;
  if (!(stream >> first >> colon >> last) || colon != ':' || stream >> rest || first < 0 || last <= first) {
    throw CLI::ValidationError("--frames", "'" + text + "' is not A:B with 0 <= A < B (frames A to B-1)");
  }
  return {first, last};
}

// As it could be typed again.
std::string CommandLine(int argc, char** argv) {
  std::string line = "vobench";
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const bool plain = !argument.empty() && argument.find_first_of(" \t\n'\"\\$`*?;&|<>(){}[]~#!") == std::string::npos;
    std::string quoted;
    for (const char c : argument) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    line += " " + (plain ? argument : "'" + quoted + "'");
  }
  return line;
}

Overrides OverridesOf(const OptionTable& table) {
  Overrides all;
  if (!table.engine.empty()) all.emplace_back("render.engine", table.engine);
  for (const std::string& text : table.set) all.push_back(ParseOverride(text));
  return all;
}

Command CommandOf(OptionTable& table, const std::string& line) {
  const CLI::App& asked = *table.app.get_subcommands().front();
  const std::string& name = asked.get_name();
  if (name == "render") {
    RenderOptions& render = table.render;
    if (!table.frames.empty()) render.frames = ParseFrames(table.frames);
    if (asked.count("--seed") > 0) render.seed = table.seed;
    render.jobs = table.jobs;
    render.overrides = OverridesOf(table);
    return render;
  }
  if (name == "track") {
    table.track.seed = table.seed;
    table.track.overrides = OverridesOf(table);
    table.track.command_line = line;
    return table.track;
  }
  if (name == "run") {
    RunOptions& run = table.run;
    if (std::set<std::string>(run.systems.begin(), run.systems.end()).size() != run.systems.size()) {
      throw CLI::ValidationError("--system", "names a system twice");
    }
    run.verdict = run.verdict || run.require_consistent;
    run.seed = table.seed;
    run.jobs = table.jobs;
    run.overrides = OverridesOf(table);
    run.command_line = line;
    return run;
  }
  if (name == "check") {
    table.check.overrides = OverridesOf(table);
    return table.check;
  }
  if (name == "campaign") {
    table.campaign.jobs = table.jobs;
    return table.campaign;
  }
  if (name == "evaluate") return table.evaluate;
  if (name == "verify") return table.verify;
  if (name == "export") return table.exported;
  if (name == "settings") return table.settings;
  return table.report;
}

}  // namespace

std::variant<Command, int> ParseArguments(int argc, char** argv) {
  OptionTable table;
  try {
    table.app.parse(argc, argv);
    return CommandOf(table, CommandLine(argc, argv));
  } catch (const CLI::ParseError& error) {
    return table.app.exit(error) == 0 ? 0 : 2;
  }
}

}  // namespace vobench
