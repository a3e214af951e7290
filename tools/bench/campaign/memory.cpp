#include "tools/bench/campaign/memory.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

namespace vobench::campaign {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t kUnknown = std::numeric_limits<std::uint64_t>::max();

std::uint64_t NumberIn(const fs::path& file) {
  std::ifstream stream(file);
  std::uint64_t value = 0;
  return stream >> value ? value : kUnknown;  // "max", too
}

// Of a line "NAME VALUE ...".
std::uint64_t NumberOf(const std::string& name, const fs::path& file) {
  std::ifstream stream(file);
  for (std::string word; stream >> word;) {
    std::uint64_t value = 0;
    if (word == name && stream >> value) return value;
  }
  return kUnknown;
}

// The control group (v2) of this process, "/" being that of which the files are in sys/fs/cgroup itself.
fs::path OwnGroup(const fs::path& root) {
  std::ifstream stream(root / "proc/self/cgroup");
  const std::string v2 = "0::";
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with(v2)) return fs::path(line.substr(v2.size())).lexically_normal();
  }
  return "/";
}

// What a group may take beside what it has; file cache that nobody has used of late is given back when it is asked for.
std::uint64_t LeftIn(const fs::path& group) {
  const std::uint64_t most = NumberIn(group / "memory.max"), taken = NumberIn(group / "memory.current");
  if (most == kUnknown || taken == kUnknown) return kUnknown;
  const std::uint64_t cache = NumberOf("inactive_file", group / "memory.stat");
  const std::uint64_t used = cache == kUnknown ? taken : taken - std::min(taken, cache);
  return most - std::min(most, used);
}

}  // namespace

std::uint64_t AvailableMemory(const fs::path& root) {
  const std::uint64_t kilobytes = NumberOf("MemAvailable:", root / "proc/meminfo");
  std::uint64_t available = kilobytes == kUnknown ? kUnknown : kilobytes * 1024;
  // A group may have no more than those that it is in.
  for (fs::path group = OwnGroup(root);; group = group.parent_path()) {
    available = std::min(available, LeftIn(root / "sys/fs/cgroup" / group.relative_path()));
    if (!group.has_relative_path()) return available;
  }
}

Share ShareOut(std::uint64_t available, int wanted, std::uint64_t each) {
  if (each == 0 && available == kUnknown) return {wanted, 0};
  if (each == 0) return {wanted, std::max<std::uint64_t>(1, available / static_cast<std::uint64_t>(wanted))};
  const std::uint64_t fit = std::max<std::uint64_t>(1, available / each);
  return {static_cast<int>(std::min<std::uint64_t>(static_cast<std::uint64_t>(wanted), fit)), each};
}

}  // namespace vobench::campaign
