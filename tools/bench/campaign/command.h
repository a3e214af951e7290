// Shell command in a process group of its own, with a time-out; its output goes to a file.
#pragma once

#include <filesystem>
#include <string>

namespace vobench::campaign {

struct CommandEnd {
  bool timed_out = false;
  int signal = 0;  // that ended it
  int status = 0;  // its exit status otherwise
};

// Starts `command` in `folder`. When it ends, remaining processes of its group are killed. At the time-out, or when
// this process dies (by SIGKILL, too), the group is sent SIGTERM, and three seconds later SIGKILL. Throws
// std::runtime_error when it cannot be started at all.
CommandEnd RunCommand(const std::string& command, const std::filesystem::path& folder, const std::filesystem::path& log,
                      double timeout_s);

}  // namespace vobench::campaign
