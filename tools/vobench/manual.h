// Purpose: the option table as a man page and as completions of the shells. Made when the program is built.
// Source:  docs/install.md.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace vobench {

// Of section 1, in roff.
std::string ManPage(const CLI::App& app, const std::string& version);

// Commands, options, choices, and files where an option takes one.
std::string BashCompletion(const CLI::App& app);
std::string ZshCompletion(const CLI::App& app);
std::string FishCompletion(const CLI::App& app);

}  // namespace vobench
