// SIGKILL at random moments: the files left are complete or not used, and the same command then ends with the bytes of
// an uninterrupted run. VOBENCH_KILLS=N: kills (20 by default). VOBENCH_FAULTS_REPORT=FILE appends the figures to FILE.
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <random>

#include "tests/system/campaign.h"
#include "tests/system/faults/fault_trial.h"

namespace vobench::system_test {
namespace {
namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

int Kills() {
  const char* asked = std::getenv("VOBENCH_KILLS");
  return asked != nullptr ? std::atoi(asked) : 20;
}

double SecondsSince(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

class KillsTest : public CampaignTest {
 protected:
  // Runs one command until it ends by itself or was killed `most` times, each time at a random moment within `whole_s`;
  // look() after each kill. Returns the number of kills.
  int KilledUntilDone(const std::vector<std::string>& words, double whole_s, int most,
                      const std::function<void()>& look) {
    int kills = 0;
    while (kills < most) {
      const auto start = Clock::now();
      const double after_s = std::uniform_real_distribution<>(0, whole_s)(random_);
      moments_ += std::to_string(after_s) + " ";
      if (!KillVobench(words, here_.path(), [&] { return SecondsSince(start) >= after_s; })) break;
      ++kills;
      look();
    }
    return kills;
  }

  void Report(const std::string& name, int kills, int runs) const {
    if (const char* file = std::getenv("VOBENCH_FAULTS_REPORT")) {
      std::ofstream(file, std::ios::app) << "| " << name << " | " << kills << " | " << runs << " |\n";
    }
  }

  std::mt19937 random_{std::random_device{}()};  // random moments, printed by a failure
  std::string moments_;
};

TEST_F(KillsTest, Render) {
  WriteFile(here_ / "small.yaml", SmallScenario("1 s"));
  const auto words = [](const std::string& out) {
    return std::vector<std::string>{"render", "small.yaml", "-o", out, "--jobs", "2", "--resume"};
  };
  const auto start = Clock::now();
  ASSERT_EQ(RunVobench(words("whole"), here_.path()).status, 0);
  const double whole_s = SecondsSince(start);
  const auto expected = Tree(here_ / "whole");
  int kills = 0, runs = 0;
  for (; kills < Kills(); ++runs) {
    moments_.clear();
    kills += KilledUntilDone(words("seq"), whole_s, Kills() - kills, [&] {
      EXPECT_FALSE(fs::exists(here_ / "seq") && fs::exists(here_ / "seq.partial")) << moments_;
      // Under its final name the sequence is complete; the journal may still be there.
      if (!fs::exists(here_ / "seq")) return;
      auto there = Tree(here_ / "seq");
      std::erase_if(there, [&](const auto& file) { return !expected.contains(file.first); });
      EXPECT_TRUE(there == expected) << moments_;
    });
    const Outcome outcome = RunVobench(words("seq"), here_.path());
    ASSERT_EQ(outcome.status, 0) << outcome.err << moments_;
    ASSERT_TRUE(Tree(here_ / "seq") == expected) << moments_;
    ASSERT_FALSE(fs::exists(here_ / "seq.partial")) << moments_;
    fs::remove_all(here_ / "seq");
  }
  Report("render", kills, runs);
}

TEST_F(KillsTest, Campaign) {
  int kills = 0, runs = 0;
  WriteFile(here_ / "small.yaml", SmallScenario("0.4 s"));
  const std::string images = Images(here_ / "small.yaml");
  for (const std::string& text : {Points("1"), images}) {
    const auto start = Clock::now();
    MustRun(text, "whole");
    const double whole_s = SecondsSince(start);
    const auto expected = Lasting("whole");
    const int most = text == images ? Kills() : (Kills() + 1) / 2;
    for (; kills < most; ++runs) {
      moments_.clear();
      kills += KilledUntilDone(Words("out"), whole_s, most - kills, [&] {
        // The table exists only after all tasks, and is then complete.
        if (!fs::exists(here_ / "out" / "results.csv")) return;
        EXPECT_EQ(Results("out"), expected.at("results.csv")) << moments_;
      });
      MustRun(text, "out");
      ASSERT_TRUE(Lasting("out") == expected) << moments_;
      fs::remove_all(here_ / "out");
    }
    fs::remove_all(here_ / "whole");
  }
  Report("campaign", kills, runs);
}

}  // namespace
}  // namespace vobench::system_test
