// Purpose: how many processes fit into this machine's memory.
#pragma once

#include <cstdint>

namespace campaign {

// What can be had without swapping: of the machine, or of the control group that this process is in. [bytes]
std::uint64_t AvailableMemory();

struct Share {
  int processes = 1;
  std::uint64_t bytes = 0;  // that each may have
};

// `wanted` processes of `each` bytes, or as many as fit, one at least. each = 0: an equal part of what is available.
Share ShareOut(std::uint64_t available, int wanted, std::uint64_t each);

}  // namespace campaign
