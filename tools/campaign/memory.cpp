#include "tools/campaign/memory.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

namespace campaign {
namespace {

constexpr std::uint64_t kUnknown = std::numeric_limits<std::uint64_t>::max();

std::uint64_t NumberIn(const char* file) {
  std::ifstream stream(file);
  std::uint64_t value = 0;
  return stream >> value ? value : kUnknown;  // "max", too
}

}  // namespace

std::uint64_t AvailableMemory() {
  std::uint64_t available = kUnknown;
  std::ifstream stream("/proc/meminfo");
  for (std::string word; stream >> word;) {
    std::uint64_t kilobytes = 0;
    if (word == "MemAvailable:" && stream >> kilobytes) available = kilobytes * 1024;
  }
  const std::uint64_t most = NumberIn("/sys/fs/cgroup/memory.max"), used = NumberIn("/sys/fs/cgroup/memory.current");
  if (most != kUnknown && used != kUnknown) available = std::min(available, most > used ? most - used : 0);
  return available;
}

Share ShareOut(std::uint64_t available, int wanted, std::uint64_t each) {
  if (each == 0) return {wanted, available == kUnknown ? 0 : available / static_cast<std::uint64_t>(wanted)};
  const std::uint64_t fit = std::max<std::uint64_t>(1, available / each);
  return {static_cast<int>(std::min<std::uint64_t>(static_cast<std::uint64_t>(wanted), fit)), each};
}

}  // namespace campaign
