// Resume after SIGKILL: the next start of a campaign ends with the bytes of an uninterrupted one.
#include <signal.h>
#include <sys/wait.h>

#include <chrono>
#include <fstream>
#include <random>
#include <thread>

#include "tests/system/campaign.h"

namespace vobench::system_test {
namespace {
namespace fs = std::filesystem;
using std::chrono::milliseconds;
using testing::HasSubstr;

std::vector<int> ChildrenOf(int process) {
  const std::string number = std::to_string(process);
  std::ifstream stream("/proc/" + number + "/task/" + number + "/children");
  return {std::istream_iterator<int>(stream), {}};
}

class CampaignKillTest : public CampaignTest {
 protected:
  std::mt19937 random_{std::random_device{}()};  // random moments, printed by the test
  int Draw(int largest) { return std::uniform_int_distribution<>(0, largest)(random_); }
};

TEST_F(CampaignKillTest, TheCampaignKilledAgainAndAgain) {
  for (const std::string& text : {Points(), Images()}) {
    const auto began = std::chrono::steady_clock::now();
    MustRun(text, "whole");
    const auto all = std::chrono::duration_cast<milliseconds>(std::chrono::steady_clock::now() - began);
    int kills = 0;
    std::string moments;
    for (int n = 0; n < 6; ++n) {
      const auto start = std::chrono::steady_clock::now();
      const auto after = milliseconds(Draw(static_cast<int>(all.count()) / 12));  // the machine may be less busy by now
      const std::size_t tasks = Done("out") + 1;
      moments += n % 2 != 0 ? std::to_string(after.count()) + " ms, " : std::to_string(tasks) + " tasks, ";
      kills += KillVobench(Words("out"), here_.path(), [&] {
        return n % 2 != 0 ? std::chrono::steady_clock::now() - start >= after : Done("out") >= tasks;
      });
    }
    SCOPED_TRACE("killed after " + moments + "of " + std::to_string(all.count()) + " ms");
    EXPECT_GT(kills, 1);
    MustRun(text, "out");
    EXPECT_TRUE(Lasting("out") == Lasting("whole"));
    fs::remove_all(here_ / "whole");
    fs::remove_all(here_ / "out");
  }
}

TEST_F(CampaignKillTest, ATaskThatIsKilledIsRecordedAndTriedAgain) {
  MustRun(Points(), "whole");
  const int campaign = StartVobench(Words("out"), here_.path());
  int killed = 0;
  int status = 0;
  while (waitpid(campaign, &status, WNOHANG) == 0) {
    if (killed < 3 && Done("out") >= static_cast<std::size_t>(1 + 4 * killed)) {
      for (const int child : ChildrenOf(campaign)) killed += kill(child, SIGKILL) == 0;
    }
    std::this_thread::sleep_for(milliseconds(1));
  }
  EXPECT_GE(killed, 3);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 1);
  const std::string csv = Results("out");
  EXPECT_THAT(csv, HasSubstr(",failed,"));
  EXPECT_THAT(csv, HasSubstr("ended by signal 9 (Killed)\n"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 31) << "the rest went on";
  MustRun(Points(), "out");
  EXPECT_TRUE(Lasting("out") == Lasting("whole"));
}

TEST_F(CampaignKillTest, TheCampaignTakesItsProcessesAlong) {
  std::string text = Points();
  text.replace(text.find("2 s"), 3, "90 s");
  WriteFile(here_ / "c.yaml", text);
  const int campaign = StartVobench(Words("out"), here_.path());
  std::vector<int> children;
  while (children.size() < 2) {
    children = ChildrenOf(campaign);
    ASSERT_EQ(kill(campaign, 0), 0);
    std::this_thread::sleep_for(milliseconds(1));
  }
  kill(campaign, SIGKILL);
  waitpid(campaign, nullptr, 0);
  for (const int child : children) {
    const auto alive = [&] {
      std::ifstream stream("/proc/" + std::to_string(child) + "/stat");
      std::string number, name, state;
      return stream >> number >> name >> state && state != "Z";
    };
    for (int tries = 0; alive() && tries < 2000; ++tries) std::this_thread::sleep_for(milliseconds(1));
    EXPECT_FALSE(alive());
  }
}

TEST_F(CampaignKillTest, ATaskThatHangsFailsAndTheOthersGoOn) {
  std::string text = Points("1");
  text.replace(text.find("particles: 16"), 13, "particles: 100000");
  text.replace(text.find("[0.5 px, 1 px, 2 px]"), 20, "[0.5 px]");
  const Outcome outcome = Run(text, "out", {"--timeout", "4"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err,
              testing::AllOf(HasSubstr("1 of 2 tasks"), HasSubstr("task 1 (points, noise 0.5 px, rbpf_16, seed 1)"),
                             HasSubstr("4 s of --timeout")));
  EXPECT_THAT(Results("out"), testing::ContainsRegex(",rb2pf,[^\n]*,ok,"));
}

TEST_F(CampaignKillTest, CtrlC) {
  MustRun(Points(), "whole");
  const std::string when_some_are_done =
      "(until [ -d out/tasks/00/000003 ]; do sleep 0.01; done; kill -INT $$) &\nexec \\";
  const Outcome outcome = RunVobench(Words("out"), here_.path(), when_some_are_done);
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, testing::ContainsRegex("interrupted.* [0-9]+ of 30 tasks"));
  EXPECT_LT(Done("out"), 30u);
  MustRun(Points(), "out");
  EXPECT_TRUE(Lasting("out") == Lasting("whole"));
}

TEST_F(CampaignKillTest, TwoCannotWorkOnTheSameFolder) {
  std::string text = Points();
  text.replace(text.find("2 s"), 3, "90 s");
  WriteFile(here_ / "c.yaml", text);
  const int first = StartVobench(Words("out"), here_.path());
  while (ChildrenOf(first).empty()) std::this_thread::sleep_for(milliseconds(1));
  const Outcome second = RunVobench(Words("out"), here_.path());
  kill(first, SIGKILL);
  waitpid(first, nullptr, 0);
  EXPECT_EQ(second.status, 1);
  EXPECT_THAT(second.err, HasSubstr("another process is at work on this campaign"));
}

}  // namespace
}  // namespace vobench::system_test
