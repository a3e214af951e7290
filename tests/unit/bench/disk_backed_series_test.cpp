#include "tools/bench/tracking/disk_backed_series.h"

#include <gmock/gmock.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <numeric>
#include <vector>

#include "tests/unit/judge/evaluation/temporary_folder.h"

namespace vobench {
namespace {

using evaluation::TemporaryFolder;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

struct Record {
  std::int64_t number;
  double half;
};

std::vector<std::int64_t> Numbers(const DiskBackedSeries<Record>& spool) {
  std::vector<std::int64_t> numbers;
  spool.ForEach([&](const Record& record) {
    EXPECT_EQ(record.half, 0.5 * static_cast<double>(record.number));
    numbers.push_back(record.number);
  });
  return numbers;
}

// Series below, at and above the capacity of memory, read repeatedly while it grows.
TEST(DiskBackedSeries, GivesBackAllInOrder) {
  const TemporaryFolder folder;
  DiskBackedSeries<Record> spool(folder.path(), 4);
  std::vector<std::int64_t> expected;
  for (std::int64_t k = 0; k < 14; ++k) {
    EXPECT_EQ(spool.size(), expected.size());
    EXPECT_EQ(Numbers(spool), expected);
    spool.Add({k, 0.5 * static_cast<double>(k)});
    expected.push_back(k);
  }
  const DiskBackedSeries<Record> moved = std::move(spool);
  EXPECT_EQ(Numbers(moved), expected);
}

TEST(DiskBackedSeries, LeavesNothingToSeeInItsFolder) {
  const TemporaryFolder folder;
  DiskBackedSeries<Record> spool(folder.path(), 4);
  for (std::int64_t k = 0; k < 14; ++k) spool.Add({k, 0});
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(DiskBackedSeries, AShortSeriesTouchesNoDisk) {
  DiskBackedSeries<Record> spool("/nowhere", 4);
  for (std::int64_t k = 0; k < 4; ++k) spool.Add({k, 0});
  EXPECT_THAT(
      [&] {
        spool.Add({4, 0});
      },
      ThrowsMessage<std::runtime_error>(AllOf(HasSubstr("/nowhere: "), HasSubstr("No such file or directory"))));
}

TEST(DiskBackedSeries, FullDisk) {
  const TemporaryFolder folder;
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit limit{8 * sizeof(Record), before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &limit);
  DiskBackedSeries<Record> spool(folder.path(), 4);
  EXPECT_NO_THROW({
    for (std::int64_t k = 0; k < 12; ++k) spool.Add({k, 0});
  });
  EXPECT_THAT(
      [&] {
        spool.Add({12, 0});
      },
      ThrowsMessage<std::runtime_error>(
          AllOf(HasSubstr(folder.path().string() + ": cannot keep what a long run has answered so far"),
                HasSubstr("File too large"))));
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
}

TEST(DiskBackedSeries, WithoutAFolderAllIsInMemory) {
  DiskBackedSeries<Record> spool(std::nullopt, 4);
  for (std::int64_t k = 0; k < 14; ++k) spool.Add({k, 0.5 * static_cast<double>(k)});
  EXPECT_EQ(Numbers(spool).size(), 14u);
}

}  // namespace
}  // namespace vobench
