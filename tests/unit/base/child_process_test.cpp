#include "tools/base/child_process.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <stdexcept>
#include <string>

namespace base {
namespace {

TEST(ChildProcess, AnswersThroughAPipe) {
  const std::string sent(300'000, 'x');  // more than a pipe holds
  const ChildProcess child([&](int answer) { return WriteAll(answer, sent) == 0 ? 7 : 1; });
  EXPECT_EQ(child.ReadAnswer(), sent);
  const ExitStatus end = child.Wait();
  EXPECT_EQ(end.status, 7);
  EXPECT_EQ(end.signal, 0);
}

TEST(ChildProcess, AnExceptionIsStatusOne) {
  const ChildProcess child([](int) -> int { throw std::runtime_error("x"); });
  EXPECT_EQ(child.ReadAnswer(), "");
  EXPECT_EQ(child.Wait().status, 1);
}

TEST(ChildProcess, ADeadlineEndsTheWaitAndKillTheChild) {
  const ChildProcess child([](int answer) {
    WriteAll(answer, "half");
    return pause();
  });
  EXPECT_EQ(child.ReadAnswer(After(0.1)), std::nullopt);
  EXPECT_FALSE(child.Poll());
  child.Kill();
  EXPECT_EQ(child.Wait().signal, SIGKILL);
}

TEST(ChildProcess, DiesWithTheProcessThatStartedIt) {
  const ChildProcess child([](int answer) {
    const ChildProcess grandchild([answer](int) { return pause() + answer; });  // inherits the pipe
    return 0;
  });
  EXPECT_EQ(child.ReadAnswer(After(20)), "") << "the grandchild has closed the pipe";
  EXPECT_EQ(child.Wait().status, 0);
}

TEST(WaitForSignal, TakesABlockedSignalOrTheDeadline) {
  const sigset_t signals = SignalSet({SIGUSR1});
  const SignalBlock blocked(signals);
  EXPECT_EQ(WaitForSignal(signals, After(0.01)), std::nullopt);
  raise(SIGUSR1);
  EXPECT_EQ(WaitForSignal(signals, After(20)), SIGUSR1);
}

}  // namespace
}  // namespace base
