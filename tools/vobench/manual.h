// Man page and bash completion from the option table, made when the program is built.
// Source: docs/install.md.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace vobench {

// Of section 1, in roff.
std::string ManPage(const CLI::App& app, const std::string& version);

// Commands, options, choices, and files where an option takes one.
std::string BashCompletion(const CLI::App& app);

}  // namespace vobench
