// Number of processes that fit into this machine's memory.
#pragma once

#include <cstdint>
#include <filesystem>

namespace vobench::campaign {

// What can be had without swapping: of the machine, or of the control groups (v2) that this process is in. The files of
// the system are below `root`. [bytes]
std::uint64_t AvailableMemory(const std::filesystem::path& root = "/");

struct Share {
  int processes = 1;
  std::uint64_t bytes = 0;  // that each may have; 0: no limit, as nobody knows what is available
};

// `wanted` processes of `each` bytes, or as many as fit, one at least. each = 0: an equal part of what is available,
// never 0 of it.
Share ShareOut(std::uint64_t available, int wanted, std::uint64_t each);

}  // namespace vobench::campaign
