// Processes that crash, hang, or take too much; external commands; locks and folders that survive them.
#include <gmock/gmock.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <latch>
#include <map>
#include <memory>
#include <thread>
#include <vector>

#include "tests/unit/bench/campaign/folder.h"
#include "tools/bench/campaign/command.h"
#include "tools/bench/campaign/output.h"
#include "tools/bench/campaign/process_pool.h"
#include "tools/bench/campaign/sequence_cache.h"
#include "tools/bench/errors.h"

namespace vobench::campaign {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;
using testing::HasSubstr;

std::map<std::int64_t, std::string> WaitForAll(ProcessPool& pool) {
  std::map<std::int64_t, std::string> ends;
  while (pool.running() > 0) {
    if (const auto end = pool.Wait(milliseconds(1000))) ends[end->id] = end->problem;
  }
  return ends;
}

TEST(ProcessPool, ExitStatuses) {
  ProcessPool pool;
  pool.Start(1, {}, [] {});
  pool.Start(2, {}, [] { throw std::runtime_error("no such file"); });
  pool.Start(3, {}, [] { raise(SIGSEGV); });
  pool.Start(4, {0, 0.2}, [] { std::this_thread::sleep_for(std::chrono::minutes(1)); });
  pool.Start(5, {}, [] { throw std::runtime_error(std::string(100'000, 'x')); });  // more than a pipe holds
  pool.Start(6, {}, [] { _exit(7); });
  const auto ends = WaitForAll(pool);
  EXPECT_EQ(ends.at(1), "");
  EXPECT_EQ(ends.at(2), "no such file");
  EXPECT_THAT(ends.at(3), HasSubstr("ended by signal 11 ("));
  EXPECT_EQ(ends.at(4), "took longer than the 0.2 s of --timeout");
  EXPECT_THAT(ends.at(5), testing::StartsWith("xxx"));
  EXPECT_EQ(ends.at(6), "ended with status 7");
}

TEST(ProcessPool, BoundsMemory) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a sanitizer ends a process that is out of memory in its own way";
#endif
  ProcessPool pool;
  const auto take = [](std::size_t bytes) {
    return [bytes] {
      std::vector<char> much(bytes, 1);
      if (much[bytes / 2] != 1) throw std::logic_error("");
    };
  };
  pool.Start(1, {200'000'000, 0}, take(100'000'000));
  pool.Start(2, {200'000'000, 0}, take(400'000'000));
  const auto ends = WaitForAll(pool);
  EXPECT_EQ(ends.at(1), "");
  EXPECT_EQ(ends.at(2), "out of memory: more than the 0.2 GB of --memory");
}

TEST(ProcessPool, KillsWhatRunsWhenItGoes) {
  const Folder here;
  const auto began = steady_clock::now();
  {
    ProcessPool pool;
    pool.Start(1, {}, [&] {
      std::this_thread::sleep_for(std::chrono::seconds(60));
      here.Write("late", "");
    });
  }
  EXPECT_LT(steady_clock::now() - began, std::chrono::seconds(30));
  EXPECT_FALSE(std::filesystem::exists(here / "late"));
}

TEST(Memory, NoMoreProcessesThanFit) {
  EXPECT_EQ(ShareOut(10, 4, 3).processes, 3);
  EXPECT_EQ(ShareOut(10, 2, 3).processes, 2);
  EXPECT_EQ(ShareOut(10, 2, 30).processes, 1) << "one at least";
  EXPECT_EQ(ShareOut(10, 2, 0).limits.memory_bytes, 5u);
  EXPECT_EQ(ShareOut(1, 2, 0).limits.memory_bytes, 1u) << "0 would be no limit";
  EXPECT_EQ(ShareOut(0, 2, 0).limits.memory_bytes, 1u);
  EXPECT_GT(AvailableMemory(), 1'000'000u);
}

TEST(Memory, IsThatOfTheTightestControlGroup) {
  const Folder root;
  root.Write("proc/meminfo", "MemTotal: 9000 kB\nMemAvailable: 8000 kB\n");
  EXPECT_EQ(AvailableMemory(root.path()), 8'192'000u) << "no control groups";
  root.Write("sys/fs/cgroup/memory.max", "7000000\n");
  root.Write("sys/fs/cgroup/memory.current", "6000000\n");
  EXPECT_EQ(AvailableMemory(root.path()), 1'000'000u) << "a container sees its own group as the root";
  root.Write("sys/fs/cgroup/memory.stat", "anon 5000\ninactive_file 4000000\nactive_file 1\n");
  EXPECT_EQ(AvailableMemory(root.path()), 5'000'000u) << "6 MB, of which 4 are cache";
  root.Write("proc/self/cgroup", "0::/user/job\n");
  root.Write("sys/fs/cgroup/user/memory.max", "3000000\n");
  root.Write("sys/fs/cgroup/user/memory.current", "1000000\n");
  root.Write("sys/fs/cgroup/user/job/memory.max", "max\n");
  root.Write("sys/fs/cgroup/user/job/memory.current", "900000\n");
  EXPECT_EQ(AvailableMemory(root.path()), 2'000'000u) << "its parent's";
  root.Write("sys/fs/cgroup/user/job/memory.max", "950000\n");
  EXPECT_EQ(AvailableMemory(root.path()), 50'000u) << "its own";
  root.Write("sys/fs/cgroup/user/job/memory.current", "960000\n");
  EXPECT_EQ(AvailableMemory(root.path()), 0u);
  root.Write("proc/self/cgroup", "0::/../elsewhere\n");
  EXPECT_EQ(AvailableMemory(root.path()), 5'000'000u) << "not below here: what is seen of it";
}

class CommandTest : public testing::Test {
 protected:
  CommandEnd Run(const std::string& command, double timeout_s = 30) {
    return RunCommand(command, here_.path(), here_ / "log", timeout_s);
  }
  Folder here_;
};

TEST_F(CommandTest, ExitStatuses) {
  const CommandEnd good = Run("echo out; echo err >&2; pwd > where");
  EXPECT_EQ(good.status, 0);
  EXPECT_EQ(good.signal, 0);
  EXPECT_EQ(here_.Read("log"), "out\nerr\n");
  EXPECT_EQ(here_.Read("where"), here_.path().string() + "\n");
  EXPECT_EQ(Run("exit 3").status, 3);
  EXPECT_EQ(Run("kill -SEGV $$").signal, SIGSEGV);
  EXPECT_EQ(Run("sh -c 'kill -ABRT $$'; exit $?").signal, SIGABRT) << "as a shell passes it on";
  EXPECT_EQ(Run("/no/such/program").status, 127);
}

TEST_F(CommandTest, ItsTimeOverItIsKilledWithAllThatItStarted) {
  const auto began = steady_clock::now();
  const CommandEnd end = Run("(sleep 2; touch late) & sleep 60", 0.3);
  EXPECT_TRUE(end.timed_out);
  EXPECT_LT(steady_clock::now() - began, std::chrono::seconds(30));
  std::this_thread::sleep_for(milliseconds(2500));
  EXPECT_FALSE(std::filesystem::exists(here_ / "late"));
}

TEST_F(CommandTest, WhatItLeavesBehindGoesToo) {
  EXPECT_EQ(Run("(sleep 2; touch late) > /dev/null 2>&1 & exit 0").status, 0);
  std::this_thread::sleep_for(milliseconds(2500));
  EXPECT_FALSE(std::filesystem::exists(here_ / "late"));
}

TEST_F(CommandTest, ItsTimeOverItIsAskedToEndBeforeItIsKilled) {
  EXPECT_TRUE(Run("trap 'touch tidied; exit' TERM; sleep 60 & wait", 0.5).timed_out);
  EXPECT_TRUE(std::filesystem::exists(here_ / "tidied"));
  const auto began = steady_clock::now();
  EXPECT_TRUE(Run("trap '' TERM; sleep 60; sleep 60", 0.3).timed_out);
  EXPECT_LT(steady_clock::now() - began, std::chrono::seconds(30));
}

TEST_F(CommandTest, ASignalToItsOwnGroupIsItsOwnMatter) {
  EXPECT_EQ(Run("trap '' TERM; kill 0; exit 4").status, 4);
  EXPECT_EQ(Run("kill 0; exit 4").signal, SIGTERM);
}

bool Runs(const std::string& process) {
  std::ifstream stream("/proc/" + process + "/stat");
  std::string number, name, state;
  return stream >> number >> name >> state && state != "Z";
}

// A process that runs a command, ended by the timeout, by a kill, and with the pool.
TEST_F(CommandTest, EndsWithItsParent) {
  const auto work = [this] {
    here_.Write("caller", std::to_string(getpid()));
    Run("sh -c 'sleep 60 & echo -n $! > number; mv number grandchild; wait'; exit 0", 60);
  };
  const auto take_grandchild = [this] {
    while (!std::filesystem::exists(here_ / "grandchild")) std::this_thread::sleep_for(milliseconds(1));
    const std::string grandchild = here_.Read("grandchild");
    EXPECT_TRUE(Runs(grandchild));
    std::filesystem::remove(here_ / "grandchild");
    return grandchild;
  };
  std::string grandchild;
  {
    ProcessPool pool;
    pool.Start(1, {0, 2}, work);
    grandchild = take_grandchild();
    EXPECT_EQ(WaitForAll(pool).at(1), "took longer than the 2 s of --timeout");
    EXPECT_FALSE(Runs(grandchild)) << "after --timeout";
    pool.Start(2, {}, work);
    grandchild = take_grandchild();
    kill(std::stoi(here_.Read("caller")), SIGKILL);
    EXPECT_THAT(WaitForAll(pool).at(2), HasSubstr("ended by signal 9"));
    EXPECT_FALSE(Runs(grandchild)) << "after a kill";
    pool.Start(3, {}, work);
    grandchild = take_grandchild();
  }
  EXPECT_FALSE(Runs(grandchild)) << "after the pool";
}

TEST(FileLock, DiesWithItsProcess) {
  const Folder here;
  const auto path = here / "lock";
  const pid_t child = fork();
  if (child == 0) {
    const FileLock lock = FileLock::Wait(path, FileLock::Kind::exclusive);
    here.Write("taken", "");
    std::this_thread::sleep_for(std::chrono::minutes(1));
    _exit(0);
  }
  while (!std::filesystem::exists(here / "taken")) std::this_thread::sleep_for(milliseconds(1));
  EXPECT_FALSE(FileLock::Try(path, FileLock::Kind::exclusive).has_value());
  EXPECT_FALSE(FileLock::Try(path, FileLock::Kind::shared).has_value());
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  EXPECT_TRUE(FileLock::Try(path, FileLock::Kind::exclusive).has_value());
}

TEST(TaskFolder, AppearsWholeReplacesAndIsTakenOnce) {
  const Folder out;
  TaskRecord record;
  record.task = 12345;
  EXPECT_EQ(TaskPath(out.path(), 12345), out / "tasks/01/012345");
  {
    TaskFolder folder(out.path(), 12345);
    std::ofstream(folder.path() / "a") << "1";
    EXPECT_FALSE(ReadRecord(out.path(), 12345));
    try {
      const TaskFolder second(out.path(), 12345);
      FAIL() << "taken twice";
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), HasSubstr("another process is at work on this task"));
    }
    folder.Commit(record);
  }
  EXPECT_TRUE(ReadRecord(out.path(), 12345));
  { const TaskFolder dropped(out.path(), 12345); }
  EXPECT_EQ(out.Read("tasks/01/012345/a"), "1") << "what was not committed changes nothing";
  {
    TaskFolder folder(out.path(), 12345);
    record.reason = "again";
    folder.Commit(record);
  }
  EXPECT_EQ(ReadRecord(out.path(), 12345)->reason, "again");
  EXPECT_FALSE(std::filesystem::exists(out / "tasks/01/012345/a"));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(out / "tasks/01"), {}), 1) << "nothing else is left";
}

TEST(TaskFolder, WhatAKillLeftIsNotTakenOver) {
  const Folder out;
  out.Write("tasks/00/.000003.partial/half", "x");
  TaskFolder folder(out.path(), 3);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  out.Write("tasks/00/000004/task.json", "{\"format\": \"vobench camp");
  EXPECT_FALSE(ReadRecord(out.path(), 4));
}

TEST(SequenceCache, ChangedFilesMiss) {
  const Folder here;
  const auto mesh = here.Write("mesh", "1"), absent = here / "picture";
  SequenceCache cache(here / "cache");
  EXPECT_FALSE(cache.Inputs("world"));
  cache.Remember("world", {mesh, absent});
  const auto before = cache.Inputs("world");
  ASSERT_TRUE(before);
  EXPECT_FALSE(cache.Inputs("other"));
  here.Write("mesh", "2");
  EXPECT_FALSE(SequenceCache(here / "cache").Inputs("world"));
  here.Write("mesh", "1");
  EXPECT_EQ(SequenceCache(here / "cache").Inputs("world"), before);
  here.Write("picture", "now it is there");
  EXPECT_FALSE(SequenceCache(here / "cache").Inputs("world")) << "what was not found then would be now";
}

// Concurrent start: tasks of one campaign begin in the same empty folder.
TEST(PrepareOutput, ManyMayBeginAtOnce) {
  const Folder here;
  for (int trial = 0; trial < 200; ++trial) {
    const std::filesystem::path out = here / std::to_string(trial);
    std::vector<std::thread> threads;
    std::atomic<int> refused = 0;
    std::latch together(8);
    for (int i = 0; i < 8; ++i) {
      threads.emplace_back([&] {
        together.arrive_and_wait();
        try {
          PrepareOutput(out, "{}");
        } catch (const std::exception&) {
          ++refused;
        }
      });
    }
    for (std::thread& thread : threads) thread.join();
    ASSERT_EQ(refused, 0) << trial;
    ASSERT_EQ(here.Read(std::to_string(trial) + "/campaign.json"), "{}");
  }
  here.Write("other/notes.txt", "mine");
  EXPECT_THROW(PrepareOutput(here / "other", "{}"), BadInput);
}

TEST(RemoveFailed, LeavesWhatIsDone) {
  const Folder here;
  const auto write = [&](std::int64_t task, Status status) {
    TaskRecord record;
    record.task = task;
    record.status = status;
    here.Write(TaskPath("", task).string() + "/task.json", ToJson(record));
  };
  write(0, Status::ok);
  write(1, Status::failed);
  write(2, Status::lost);
  RemoveFailed(here.path(), {0, 1, 2, 3});
  EXPECT_EQ(PresentTasks(here.path()), (std::vector<std::int64_t>{0, 2}));
}

}  // namespace
}  // namespace vobench::campaign
