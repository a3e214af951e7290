// --help of the option table, for a terminal of 24 lines and 100 columns. Source of the man page and of bash's
// completion (docs/install.md).
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace vobench {

struct OptionRow {
  std::vector<std::string> names;  // "-o", "--output"; of a positional "SCENARIO"
  std::string argument;            // "SEQ"; empty: a flag, or a positional
  std::string text;                // "Sequence folder to make (required)", "... [tum]"
  bool positional = false;
  bool required = false;
  std::string Synopsis() const;  // "-o, --output SEQ"
};

// In the order of the table; the positional first, --help last.
std::vector<OptionRow> RowsOf(const CLI::App& command);
std::vector<const CLI::App*> CommandsOf(const CLI::App& app);
// "vobench render [OPTIONS] SCENARIO -o SEQ": the required arguments.
std::string Usage(const CLI::App& command);

std::string HelpText(const CLI::App& command);

}  // namespace vobench
