#include <algorithm>
#include <vector>

#include "tools/base/text.h"
#include "tools/vobench/help_text.h"
#include "tools/vobench/manual.h"

namespace vobench {
namespace {

std::vector<std::string> Names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const OptionRow& row : RowsOf(command)) {
    if (!row.positional) names.insert(names.end(), row.names.begin(), row.names.end());
  }
  return names;
}

std::vector<std::string> CommandNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : CommandsOf(app)) names.push_back(command->get_name());
  return names;
}

}  // namespace

std::string BashCompletion(const CLI::App& app) {
  std::string text =
      "# Completion of vobench for bash, made from its option table.\n"
      "_vobench() {\n"
      "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} command=\n"
      "  COMPREPLY=()\n"
      "  ((COMP_CWORD > 1)) && command=${COMP_WORDS[1]}\n"
      "  case $command,$before in\n";
  for (const CLI::App* command : CommandsOf(app)) {
    for (const OptionRow& row : RowsOf(*command)) {
      if (row.positional || row.argument.empty()) continue;
      std::vector<std::string> patterns;
      for (const std::string& name : row.names) patterns.push_back(command->get_name() + "," + name);
      text += "    " + base::Join(patterns, "|") + ") ";
      if (!row.choices.empty())
        text += "COMPREPLY=($(compgen -W '" + base::Join(row.choices, " ") + "' -- \"$word\")); ";
      else if (row.path)
        text += "compopt -o default 2>/dev/null; ";
      text += "return ;;\n";
    }
  }
  text += "  esac\n  case $command in\n    '') COMPREPLY=($(compgen -W '" + base::Join(CommandNames(app), " ") + " " +
          base::Join(Names(app), " ") + "' -- \"$word\")); return ;;\n";
  for (const CLI::App* command : CommandsOf(app)) {
    text += "    " + command->get_name() + ") [[ $word == -* ]] && COMPREPLY=($(compgen -W '" +
            base::Join(Names(*command), " ") + "' -- \"$word\")) && return ;;\n";
  }
  return text + "  esac\n  compopt -o default 2>/dev/null\n}\ncomplete -F _vobench vobench\n";
}

}  // namespace vobench
