// Option table of the command line: every sub-command with its options and their --help. Defaults are those of the
// option structs.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>

#include "tools/vobench/arguments.h"

namespace vobench {

// Not to be copied: `app` writes into `asked` when it parses.
struct OptionTable {
  OptionTable();
  OptionTable(const OptionTable&) = delete;
  OptionTable& operator=(const OptionTable&) = delete;

  CLI::App app;
  std::optional<Command> asked;  // once it is parsed
};

}  // namespace vobench
