// Short run of a fuzz target, with any compiler: all files of the folders, then a number of reproducible mutations of
// them.
// Usage:  NAME CHANGES FOLDER...     Folders may be missing.
// Exit:   2 without any input.
// Limits: 64 KiB of input for a mutation; more than one second of CPU time in user mode in a run is a finding. The
//         kernel's share is left out: the page faults of libdraco's 256 MB for a damaged count depend on the machine.
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <vector>

#include "tests/fuzz/hold.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

namespace fs = std::filesystem;
using Input = std::vector<std::uint8_t>;

constexpr std::size_t kLongest = 64 * 1024;

// splitmix64 (Steele, Lea, Flood 2014).
class Random {
 public:
  std::uint64_t Next() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  std::size_t Below(std::size_t n) { return static_cast<std::size_t>(Next() % n); }

 private:
  std::uint64_t state_ = 1;
};

// One to four mutations: byte replaced, bit flipped, bytes deleted, bytes duplicated, piece of another input inserted,
// end cut off, extreme value inserted.
Input Changed(Random& random, const std::vector<Input>& inputs) {
  static constexpr std::array<const char*, 10> kWords = {
      "nan", "-1", "0", "1e400", "2147483648", "99999999999999999999", "..", "/", "[[[[", "\xff\xff\xff\xff"};
  Input input = inputs[random.Below(inputs.size())];
  for (std::size_t changes = 1 + random.Below(4); changes > 0; --changes) {
    const std::size_t at = random.Below(input.size() + 1), left = input.size() - at;
    const auto place = input.begin() + static_cast<std::ptrdiff_t>(at);
    switch (random.Below(7)) {
      case 0:
        if (left > 0) input[at] = static_cast<std::uint8_t>(random.Next());
        break;
      case 1:
        if (left > 0) input[at] = static_cast<std::uint8_t>(input[at] ^ (1u << random.Below(8)));
        break;
      case 2:
        input.erase(place, place + static_cast<std::ptrdiff_t>(std::min(left, random.Below(16))));
        break;
      case 3: {
        const Input copy(place, place + static_cast<std::ptrdiff_t>(std::min(left, random.Below(64))));
        input.insert(place, copy.begin(), copy.end());
        break;
      }
      case 4: {
        const Input& other = inputs[random.Below(inputs.size())];
        const std::size_t from = random.Below(other.size() + 1),
                          count = std::min(other.size() - from, random.Below(64));
        const auto first = other.begin() + static_cast<std::ptrdiff_t>(from);
        input.insert(place, first, first + static_cast<std::ptrdiff_t>(count));
        break;
      }
      case 5:
        if (random.Below(4) == 0) input.resize(at);
        break;
      default: {
        const std::string word = kWords[random.Below(kWords.size())];
        const auto end = place + static_cast<std::ptrdiff_t>(std::min(left, word.size()));
        input.insert(input.erase(place, end), word.begin(), word.end());
      }
    }
  }
  if (input.size() > kLongest) input.resize(kLongest);
  return input;
}

double UserSeconds() {
  double seconds = 0;
  for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage usage{};
    getrusage(who, &usage);
    seconds += static_cast<double>(usage.ru_utime.tv_sec) + 1e-6 * static_cast<double>(usage.ru_utime.tv_usec);
  }
  return seconds;
}

void Run(const Input& input, const std::string& what) {
  // Kept until the run ends: after a crash the file holds its input.
  const fs::path last = fs::temp_directory_path() / ("vobench_fuzz_last_" + std::to_string(getpid()));
  std::ofstream(last, std::ios::binary)
      .write(reinterpret_cast<const char*>(input.data()), static_cast<std::streamsize>(input.size()));
  const double before = UserSeconds();
  LLVMFuzzerTestOneInput(input.data(), input.size());
  const double took = UserSeconds() - before;
#if !defined(__SANITIZE_ADDRESS__)
  if (input.size() <= kLongest && took > 1)
    fuzz::Finding(what + " took " + std::to_string(took) + " s of CPU time: " + last.string());
#endif
  fs::remove(last);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return std::fprintf(stderr, "usage: %s CHANGES FOLDER...\n", argv[0]), 2;
  std::map<fs::path, Input> files;
  for (int i = 2; i < argc; ++i) {
    if (!fs::is_directory(argv[i])) continue;
    for (const fs::directory_entry& entry : fs::directory_iterator(argv[i])) {
      std::ifstream stream(entry.path(), std::ios::binary);
      files[entry.path()] = {std::istreambuf_iterator<char>(stream), {}};
    }
  }
  if (files.empty()) return std::fprintf(stderr, "%s: no input\n", argv[0]), 2;
  std::vector<Input> inputs;
  for (auto& [path, input] : files) {
    Run(input, path.string());
    if (input.size() <= kLongest) inputs.push_back(input);
  }
  Run({}, "nothing");
  Random random;
  const long changes = std::strtol(argv[1], nullptr, 10);
  for (long i = 0; i < changes; ++i) Run(Changed(random, inputs), "change " + std::to_string(i));
  std::printf("%zu files and %ld changes of them\n", files.size(), changes);
}
