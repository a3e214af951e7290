#include <algorithm>
#include <vector>

#include "tools/base/text.h"
#include "tools/vobench/help_text.h"
#include "tools/vobench/manual.h"

namespace vobench {
namespace {

// In single quotes; '"'"' is a quote in all three shells.
std::string Quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\"'\"'") : std::string(1, c);
  return out + "'";
}

// Of a description in zsh's _arguments, where brackets and colons mean something.
std::string ForZsh(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

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

std::string ZshCompletion(const CLI::App& app) {
  std::string text =
      "#compdef vobench\n# Completion of vobench for zsh, made from its option table.\n"
      "if ((CURRENT == 2)); then\n  local -a commands=(\n";
  for (const CLI::App* command : CommandsOf(app)) {
    text += "    " + Quoted(ForZsh(command->get_name()) + ":" + command->get_description()) + "\n";
  }
  text +=
      "  )\n  _describe command commands\n  return\nfi\nlocal command=${words[2]}\nshift words\n((CURRENT--))\ncase "
      "$command in\n";
  for (const CLI::App* command : CommandsOf(app)) {
    text += "  " + command->get_name() + ") _arguments";
    for (const OptionRow& row : RowsOf(*command)) {
      const std::string values =
          row.choices.empty() ? (row.path ? "_files" : " ") : "(" + base::Join(row.choices, " ") + ")";
      if (row.positional) {
        text += " \\\n    " + Quoted("1:" + row.names.front() + ":_files");
        continue;
      }
      for (const std::string& name : row.names) {
        const std::string argument = row.argument.empty() ? "" : ":" + ForZsh(row.argument) + ":" + values;
        text += " \\\n    " + Quoted((name == "--set" ? "*" : "") + name + "[" + ForZsh(row.text) + "]" + argument);
      }
    }
    text += " ;;\n";
  }
  return text + "esac\n";
}

std::string FishCompletion(const CLI::App& app) {
  std::string text = "# Completion of vobench for fish, made from its option table.\n";
  for (const CLI::App* command : CommandsOf(app)) {
    text += "complete -c vobench -n __fish_use_subcommand -f -a " + command->get_name() + " -d " +
            Quoted(command->get_description()) + "\n";
  }
  for (const CLI::App* command : CommandsOf(app)) {
    for (const OptionRow& row : RowsOf(*command)) {
      if (row.positional) continue;
      text += "complete -c vobench -n '__fish_seen_subcommand_from " + command->get_name() + "'";
      for (const std::string& name : row.names)
        text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
      if (!row.argument.empty()) text += row.path ? " -r" : " -x";
      if (!row.choices.empty()) text += " -a '" + base::Join(row.choices, " ") + "'";
      text += " -d " + Quoted(row.text) + "\n";
    }
  }
  return text;
}

}  // namespace vobench
