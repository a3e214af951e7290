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
    if (row.positional) usage += row.required ? " " + row.names.front() : " [" + row.names.front() + "]";
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

}  // namespace vobench
