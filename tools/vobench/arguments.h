// Purpose: the command line, read into the command it asks for.
#pragma once

#include <variant>

#include "tools/vobench/commands.h"

namespace vobench {

// The command, or the exit status where there is none to run: 0 after --help and --version, 2 for a line that makes no
// sense (the reason is on stderr).
std::variant<Command, int> ParseArguments(int argc, char** argv);

}  // namespace vobench
