#include "tools/base/files.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <iterator>
#include <stdexcept>
#include <string>

#include "tests/unit/judge/evaluation/temporary_folder.h"

namespace base {
namespace {
namespace fs = std::filesystem;

using evaluation::TemporaryFolder;
using testing::HasSubstr;

TEST(WriteFile, FullDiskLeavesTheOldFile) {
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
    WriteFile(file, std::string(100'000, 'x'));
  } catch (const std::runtime_error& error) {
    said = error.what();
  }
  setrlimit(RLIMIT_FSIZE, &before);
  signal(SIGXFSZ, handler);
  EXPECT_THAT(said, HasSubstr(file.string()));
  EXPECT_EQ(TemporaryFolder::Read(file), "old");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1) << "something temporary remains";
}

std::ptrdiff_t OpenFiles() { return std::distance(fs::directory_iterator("/proc/self/fd"), {}); }

// Pieces smaller and larger than the buffer.
TEST(AtomicFile, HoldsWhatWasAppended) {
  const TemporaryFolder folder;
  const std::ptrdiff_t open = OpenFiles();
  const mode_t before = umask(026);
  for (const std::size_t piece : {1'000'003u, 3'000'000u}) {
    std::string expected;
    AtomicFile out(folder.path() / "a");
    for (int i = 0; i < 4; ++i) {
      const std::string text(piece, static_cast<char>('a' + i));
      out.Append(text);
      out.Append("\n");
      expected += text + "\n";
    }
    out.Commit();
    EXPECT_EQ(TemporaryFolder::Read(folder.path() / "a"), expected);
    EXPECT_EQ(fs::status(folder.path() / "a").permissions(), fs::perms{0640});
  }
  umask(before);
  EXPECT_EQ(OpenFiles(), open);
}

TEST(AtomicFile, LeavesNothingUncommitted) {
  const TemporaryFolder folder;
  const std::ptrdiff_t open = OpenFiles();
  AtomicFile(folder.path() / "a").Append("x");
  EXPECT_TRUE(fs::is_empty(folder.path()));
  EXPECT_EQ(OpenFiles(), open);
  // The name of a folder: it is not replaced.
  fs::create_directory(folder.path() / "b");
  folder.Write("b/c", "kept");
  EXPECT_THROW(WriteFile(folder.path() / "b", "x"), std::runtime_error);
  EXPECT_EQ(TemporaryFolder::Read(folder.path() / "b/c"), "kept");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
}

TEST(WriteFile, MissingFolderIsNamed) {
  const TemporaryFolder folder;
  try {
    WriteFile(folder.path() / "no" / "a.txt", "x");
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("no/a.txt"));
    EXPECT_THAT(error.what(), HasSubstr("No such file"));
  }
}

TEST(WriteFile, MakesFolders) {
  const TemporaryFolder folder;
  const auto message = [](const fs::path& path, const std::string& text) {
    try {
      WriteFileAndFolders(path, text);
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  const auto file = folder.path() / "new" / "a.txt";
  EXPECT_EQ(message(file, "abc"), "no error");
  EXPECT_EQ(ReadFile(file), "abc");
  EXPECT_EQ(message(file, "x"), "no error");
  EXPECT_EQ(ReadFile(file), "x") << "replaced";
  EXPECT_EQ(message(file / "b", "x"), (file / "b").string() + ": cannot be written: Not a directory");
  EXPECT_EQ(std::distance(fs::recursive_directory_iterator(folder.path()), {}), 2) << "no unfinished file is left";
}

TEST(WriteFile, ManyWritersShareNoTemporaryName) {
  const TemporaryFolder folder;
  AtomicFile first(folder.path() / "a", Writers::many), second(folder.path() / "a", Writers::many);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 2);
  first.Append("first");
  second.Append("second");
  second.Commit();
  EXPECT_EQ(ReadFile(folder.path() / "a"), "second");
  first.Commit();
  EXPECT_EQ(ReadFile(folder.path() / "a"), "first");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
}

// A file is shortened in place, where no new one can be written.
TEST(ShortenFile, NeedsNoRoom) {
  const TemporaryFolder folder;
  const fs::path file = folder.Write("list.txt", "one\ntwo\nthree\n");
  fs::create_directory(folder.path() / UnfinishedName("list.txt"));  // in the way of a new file
  ShortenFile(file, "one\n");
  EXPECT_EQ(ReadFile(file), "one\n");
}

TEST(AppendToFile, KeepsWhatIsThere) {
  const TemporaryFolder folder;
  AppendToFile(folder.path() / "a", "1\n");
  AppendToFile(folder.path() / "a", "2\n");
  EXPECT_EQ(ReadFile(folder.path() / "a"), "1\n2\n");
  EXPECT_EQ(ReadFile(folder.path() / "b"), std::nullopt);
}

void OnAlarm(int) {}

// Full pipe: each signal interrupts the write.
TEST(WriteAll, GoesOnAfterSignals) {
  int ends[2];
  ASSERT_EQ(pipe2(ends, O_CLOEXEC), 0);
  Descriptor from(ends[0]), to(ends[1]);
  struct sigaction action {
  }, before{};
  action.sa_handler = OnAlarm;  // without SA_RESTART
  sigaction(SIGALRM, &action, &before);
  const std::string sent(1 << 20, 'x');
  const pid_t child = fork();
  if (child == 0) {
    from.Close();
    sigaction(SIGALRM, &action, nullptr);
    ualarm(2000, 2000);
    _exit(WriteAll(*to, sent));
  }
  to.Close();
  usleep(50'000);
  std::string got(sent.size() + 1, 0);
  std::size_t size = 0;
  for (ssize_t more = 0; (more = read(*from, got.data() + size, got.size() - size)) > 0;)
    size += static_cast<std::size_t>(more);
  int status = -1;
  waitpid(child, &status, 0);
  sigaction(SIGALRM, &before, nullptr);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(size, sent.size());
}

TEST(AtomicFolder, AppearsWhenCommittedAndReplacesTheOldOne) {
  const TemporaryFolder folder;
  const fs::path name = folder.path() / "deep" / "a";
  { AtomicFolder(name).path(); }
  EXPECT_TRUE(fs::is_empty(folder.path())) << "the folder above it goes, too";
  for (const char* text : {"1", "2"}) {
    AtomicFolder out(name);
    WriteFile(out.path() / "file", text);
    WriteFile(out.path() / text, "");
    EXPECT_EQ(fs::exists(name), *text == '2');
    out.Commit();
    EXPECT_EQ(ReadFile(name / "file"), text);
  }
  EXPECT_FALSE(fs::exists(name / "1"));
  EXPECT_EQ(std::distance(fs::directory_iterator(name.parent_path()), {}), 1);
}

TEST(ReplaceFolder, PutsTheOldOneBack) {
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "to");
  folder.Write("to/kept", "x");
  EXPECT_THROW(ReplaceFolder(folder.path() / "not there", folder.path() / "to"), std::runtime_error);
  EXPECT_EQ(ReadFile(folder.path() / "to/kept"), "x");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
}

}  // namespace
}  // namespace base
