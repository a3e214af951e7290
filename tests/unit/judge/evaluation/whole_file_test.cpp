#include "tools/judge/evaluation/whole_file.h"

#include <gmock/gmock.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <iterator>
#include <stdexcept>
#include <string>

#include "tests/unit/judge/evaluation/temporary_folder.h"

namespace evaluation {
namespace {

using testing::HasSubstr;

TEST(WriteWhole, LeavesTheOldFileWhenTheDiskIsFull) {
  const TemporaryFolder folder;
  const auto file = folder.Write("a.txt", "old");
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto handler = signal(SIGXFSZ, SIG_IGN);
  rlimit limit = before;
  limit.rlim_cur = 1000;  // bytes: writing fails beyond, as on a full disk
  setrlimit(RLIMIT_FSIZE, &limit);
  std::string said;
  try {
    WriteWhole(file, std::string(100'000, 'x'));
  } catch (const std::runtime_error& error) {
    said = error.what();
  }
  setrlimit(RLIMIT_FSIZE, &before);
  signal(SIGXFSZ, handler);
  EXPECT_THAT(said, HasSubstr(file.string()));
  EXPECT_EQ(TemporaryFolder::Read(file), "old");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1) << "something temporary remains";
}

std::ptrdiff_t OpenFiles() { return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), {}); }

// In pieces, with more and less than is kept back, and in one that is more than that.
TEST(WholeFile, HoldsWhatWasAppended) {
  const TemporaryFolder folder;
  const std::ptrdiff_t open = OpenFiles();
  const mode_t before = umask(026);
  for (const std::size_t piece : {1'000'003u, 3'000'000u}) {
    std::string expected;
    WholeFile out(folder.path() / "a");
    for (int i = 0; i < 4; ++i) {
      const std::string text(piece, static_cast<char>('a' + i));
      out.Append(text);
      out.Append("\n");
      expected += text + "\n";
    }
    out.Commit();
    EXPECT_EQ(TemporaryFolder::Read(folder.path() / "a"), expected);
    EXPECT_EQ(std::filesystem::status(folder.path() / "a").permissions(), std::filesystem::perms{0640});
  }
  umask(before);
  EXPECT_EQ(OpenFiles(), open);
}

TEST(WholeFile, LeavesNothingUncommitted) {
  const TemporaryFolder folder;
  const std::ptrdiff_t open = OpenFiles();
  WholeFile(folder.path() / "a").Append("x");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  EXPECT_EQ(OpenFiles(), open);
  // The name is that of a folder: nothing takes its place.
  std::filesystem::create_directory(folder.path() / "b");
  folder.Write("b/c", "kept");
  EXPECT_THROW(WriteWhole(folder.path() / "b", "x"), std::runtime_error);
  EXPECT_EQ(TemporaryFolder::Read(folder.path() / "b/c"), "kept");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(WriteWhole, NamesTheFolderThatIsNotThere) {
  const TemporaryFolder folder;
  try {
    WriteWhole(folder.path() / "no" / "a.txt", "x");
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("no/a.txt"));
    EXPECT_THAT(error.what(), HasSubstr("No such file"));
  }
}

}  // namespace
}  // namespace evaluation
