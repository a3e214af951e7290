// Texts made of the option table: --help for a terminal of 24 lines and 100 columns, the man page, bash's completion
// (docs/install.md).
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace vobench {

struct OptionRow {
  std::vector<std::string> names;    // "-o", "--output"; of a positional "SCENARIO"
  std::string argument;              // "SEQ"; empty: a flag, or a positional
  std::string text;                  // "Sequence folder to make (required)", "... [tum]"
  std::vector<std::string> choices;  // where there are some
  bool positional = false;
  bool required = false;
  bool path = false;             // a file or a folder
  std::string Synopsis() const;  // "-o, --output SEQ"
};

// In the order of the table; the positional first, --help last.
std::vector<OptionRow> RowsOf(const CLI::App& command);
std::vector<const CLI::App*> CommandsOf(const CLI::App& app);
// "vobench render [OPTIONS] SCENARIO -o SEQ": what must be given.
std::string Usage(const CLI::App& command);

std::string HelpText(const CLI::App& command);

// Of section 1, in roff.
std::string ManPage(const CLI::App& app, const std::string& version);

// Commands, options, choices, and files where an option takes one.
std::string BashCompletion(const CLI::App& app);

}  // namespace vobench
