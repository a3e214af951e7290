// zlib streams do not depend on where in memory they are made: ISA-L's do (compress.cpp), for one content in some
// thousands.
#include "sim/sequence/compress.h"

#include <gtest/gtest.h>
#include <isa-l/crc.h>

#include <algorithm>
#include <set>
#include <thread>
#include <vector>

namespace sim {
namespace {

using Bytes = std::vector<std::uint8_t>;

// The first four bytes of each content have another entry in ISA-L's table, and come again, so that a match is there to
// be missed.
std::vector<Bytes> ContentsOfEveryEntry() {
  constexpr unsigned kEntries = 8192;
  std::vector<Bytes> contents;
  std::set<unsigned> seen;
  for (std::uint32_t n = 0; seen.size() < kEntries; ++n) {
    std::uint8_t first[4];
    for (int byte = 0; byte < 4; ++byte) first[byte] = static_cast<std::uint8_t>(n >> (8 * byte));
    if (!seen.insert(crc32_iscsi(first, 4, 0) % kEntries).second) continue;
    Bytes content(first, first + 4);
    std::uint32_t state = n;
    while (content.size() < 4200) {  // more than 4096: below, the table is smaller
      state = state * 1664525 + 1013904223;
      content.push_back(static_cast<std::uint8_t>(state >> 28));
    }
    std::copy_n(first, 4, &content[1000]);
    contents.push_back(std::move(content));
  }
  return contents;
}

std::vector<Bytes> Compressed(const std::vector<Bytes>& contents) {
  std::vector<Bytes> all;
  for (const Bytes& content : contents) {
    const Buffer one = Compress(content);
    all.emplace_back(one.bytes().begin(), one.bytes().end());
  }
  return all;
}

TEST(Compress, IsTheSameWhereverItRuns) {
  const std::vector<Bytes> contents = ContentsOfEveryEntry();
  const std::vector<Bytes> here = Compressed(contents);
  std::vector<Bytes> elsewhere;
  std::thread([&] { elsewhere = Compressed(contents); }).join();  // another stack, another heap
  int different = 0;
  for (std::size_t i = 0; i < contents.size(); ++i) different += here[i] != elsewhere[i];
  EXPECT_EQ(different, 0) << "of " << contents.size();
}

}  // namespace
}  // namespace sim
