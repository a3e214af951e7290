#include "tools/vobench/help_text.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <sstream>
#include <utility>

#include "tools/base/text.h"

namespace vobench {
namespace {

constexpr std::size_t kColumns = 100;

// Words in lines of at most `width`.
std::vector<std::string> Wrapped(const std::string& text, std::size_t width) {
  std::istringstream words(text);
  std::vector<std::string> lines{""};
  for (std::string word; words >> word;) {
    if (!lines.back().empty() && lines.back().size() + 1 + word.size() > width) lines.emplace_back();
    lines.back() += (lines.back().empty() ? "" : " ") + word;
  }
  return lines;
}

std::string Table(const std::vector<std::pair<std::string, std::string>>& rows) {
  std::size_t indent = 0;
  for (const auto& [name, text] : rows) indent = std::max(indent, name.size() + 4);
  std::string table;
  for (const auto& [name, text] : rows) {
    std::string begin = "  " + name + std::string(indent - name.size() - 2, ' ');
    for (const std::string& line : Wrapped(text, kColumns - indent)) {
      table += begin + line + "\n";
      begin = std::string(indent, ' ');
    }
  }
  return table;
}

// So that nothing in it is taken for a request of roff's.
std::string Roff(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
  }
  return !out.empty() && (out.front() == '.' || out.front() == '\'') ? "\\&" + out : out;
}

// Of the options that are not positional.
std::string Names(const CLI::App& command) {
  std::string names;
  for (const OptionRow& row : RowsOf(command)) {
    if (!row.positional) names += " " + base::Join(row.names, " ");
  }
  return names;
}

// Tagged paragraphs in roff.
std::string Paragraphs(const CLI::App& command) {
  std::string text;
  for (const OptionRow& row : RowsOf(command)) {
    if (row.names.front() == "-h" && command.get_parent() != nullptr) continue;
    text += ".TP\n.B " + Roff(row.Synopsis()) + "\n" + Roff(row.text) + "\n";
  }
  return text;
}

}  // namespace

std::string OptionRow::Synopsis() const {
  const std::string all = base::Join(names, ", ");
  return argument.empty() ? all : all + " " + argument;
}

std::vector<OptionRow> RowsOf(const CLI::App& command) {
  std::vector<OptionRow> rows, help;
  for (const CLI::Option* option : command.get_options()) {
    OptionRow row;
    row.positional = option->get_positional();
    row.required = option->get_required();
    if (row.positional) row.names.push_back(option->get_name(true));
    for (const std::string& name : option->get_snames()) row.names.push_back("-" + name);
    for (const std::string& name : option->get_lnames()) row.names.push_back("--" + name);
    const std::string type = option->get_type_name();  // "NAME:{tum,euroc,icl}"
    if (!row.positional && option->get_type_size() > 0) row.argument = type.substr(0, type.find(":{"));
    const std::size_t open = type.find('{'), close = type.find('}', open);
    if (close != std::string::npos) row.choices = CLI::detail::split(type.substr(open + 1, close - open - 1), ',');
    row.path = row.positional;
    for (const char* of_path : {"FILE", "SEQ", "OUT", "DIR"})
      row.path = row.path || row.argument.find(of_path) != std::string::npos;
    row.text = option->get_description();
    std::string value = option->get_default_str();
    if (value.size() > 2 && value.front() == '[') value = value.substr(1, value.size() - 2);  // of a list
    if (!value.empty()) row.text += " [" + value + "]";
    if (row.required && !row.positional) row.text += " (required)";
    const bool last = option == command.get_help_ptr() || option == command.get_version_ptr();
    (row.positional ? rows : last ? help : rows).push_back(std::move(row));
  }
  rows.insert(rows.end(), help.begin(), help.end());
  return rows;
}

std::vector<const CLI::App*> CommandsOf(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

std::string Usage(const CLI::App& command) {
  if (command.get_parent() == nullptr) return "vobench COMMAND [OPTIONS]";
  std::string usage = "vobench " + command.get_name(), required;
  for (const OptionRow& row : RowsOf(command)) {
    if (row.positional) usage += " " + row.names.front();
    if (row.required && !row.positional) required += " " + row.names.front() + " " + row.argument;
  }
  return usage + required + " [OPTIONS]";
}

std::string HelpText(const CLI::App& command) {
  std::string text = command.get_description() + "\nUsage: " + Usage(command) + "\n\n";
  std::vector<std::pair<std::string, std::string>> rows;
  for (const CLI::App* one : CommandsOf(command)) rows.emplace_back(one->get_name(), one->get_description());
  for (const OptionRow& row : RowsOf(command)) rows.emplace_back(row.Synopsis(), row.text);
  text += Table(rows) + "\n";
  for (const std::string& line : Wrapped(command.get_footer(), kColumns)) text += line + "\n";
  return text;
}

std::string ManPage(const CLI::App& app, const std::string& version) {
  std::string page = ".TH VOBENCH 1 \"\" \"vobench " + version + "\" \"User Commands\"\n.SH NAME\n";
  const std::string description = app.get_description();
  page += "vobench \\- " + Roff(description.substr(description.find(": ") + 2)) + "\n.SH SYNOPSIS\n.B " +
          Roff(Usage(app)) + "\n";
  page +=
      ".SH DESCRIPTION\nA scenario is rendered into a sequence with exact truth, an odometry runs on the sequence, and "
      "a judge that knows both says how accurate and how consistent the odometry is.\n.SH COMMANDS\n";
  for (const CLI::App* command : CommandsOf(app)) {
    page += ".SS " + Roff(Usage(*command)) + "\n" + Roff(command->get_description()) + ".\n";
    page += Paragraphs(*command);
    const std::string example = command->get_footer();
    page += ".PP\nExample:\n.PP\n.RS\n.nf\n" + Roff(example.substr(example.find(": ") + 2)) + "\n.fi\n.RE\n";
  }
  page += ".SH OPTIONS\n" + Paragraphs(app);
  const std::string footer = app.get_footer();
  const std::string status = footer.substr(footer.find("Exit status: ") + 13);
  return page + ".SH EXIT STATUS\n" + Roff(status) +
         "\n.SH FILES\n.TP\n.B /usr/share/vobench/scenes\nScenarios, meshes and textures\n";
}

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
  std::string commands, options;
  for (const CLI::App* command : CommandsOf(app)) {
    commands += command->get_name() + " ";
    options += "    " + command->get_name() + ") [[ $word == -* ]] && COMPREPLY=($(compgen -W '" + Names(*command) +
               "' -- \"$word\")) && return ;;\n";
  }
  text += "  esac\n  case $command in\n    '') COMPREPLY=($(compgen -W '" + commands + Names(app) +
          "' -- \"$word\")); return ;;\n" + options;
  return text + "  esac\n  compopt -o default 2>/dev/null\n}\ncomplete -F _vobench vobench\n";
}

}  // namespace vobench
