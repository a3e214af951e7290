#include "tools/vobench/arguments.h"

namespace vobench {
namespace {

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

}  // namespace

std::variant<Command, int> ParseArguments(int argc, char** argv) {
  OptionTable table;
  try {
    table.command_line = CommandLine(argc, argv);
    table.app.parse(argc, argv);
    return *table.asked;
  } catch (const CLI::ParseError& error) {
    return table.app.exit(error) == 0 ? 0 : 2;
  }
}

}  // namespace vobench
