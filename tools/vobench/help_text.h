// Formatter of --help for a terminal of 24 lines and 100 columns, and the rows that the man page and bash's completion
// share with it.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace vobench {

struct OptionRow {
  std::vector<std::string> names;    // "-o", "--output"; of a positional "SCENARIO"
  std::string argument;              // "SEQ"; empty: a flag, or a positional
  std::string text;                  // "Sequence folder to make (required)", "... [tum]"
  std::vector<std::string> choices;  // where there are some
  bool positional = false;
  bool path = false;             // a file or a folder
  std::string Synopsis() const;  // "-o, --output SEQ"
};

// In the order of the table; the positional first, --help last.
std::vector<OptionRow> RowsOf(const CLI::App& command);
std::vector<const CLI::App*> CommandsOf(const CLI::App& app);
// "vobench render [OPTIONS] SCENARIO -o SEQ": what must be given.
std::string Usage(const CLI::App& command);

class HelpText : public CLI::FormatterBase {
 public:
  std::string make_help(const CLI::App* command, std::string name, CLI::AppFormatMode mode) const override;
};

}  // namespace vobench
