// Determinism: equal scenario and seed give equal bytes, for any number of threads and range of frames, through files
// or in memory.
#include <gmock/gmock.h>

#include <filesystem>
#include <string>

#include "tests/system/program.h"

namespace vobench::system_test {
namespace {
namespace fs = std::filesystem;
using testing::HasSubstr;

const std::vector<std::string> kThreads = {"1", "2", "3", "8"};

class DeterminismTest : public testing::Test {
 protected:
  void Succeeds(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin() + 1, TinyScenario().string());
    Vobench(arguments);
  }
  void Vobench(const std::vector<std::string>& arguments) {
    const Outcome outcome = RunVobench(arguments, here_.path());
    ASSERT_EQ(outcome.status, 0) << outcome.err;
  }
  std::string Read(const std::string& name) const { return ReadFile(here_ / name); }

  TemporaryFolder here_;
};

TEST_F(DeterminismTest, RenderedBytesDoNotDependOnThreads) {
  Succeeds({"render", "-o", "one", "--frames", "0:6", "--jobs", "1"});
  const auto one = Tree(here_ / "one");
  EXPECT_GE(one.size(), 6U);
  for (const std::string jobs : {"2", "3", "8"}) {  // more than processors: frames are finished in another order
    Succeeds({"render", "-o", "jobs" + jobs, "--frames", "0:6", "--jobs", jobs});
    EXPECT_TRUE(one == Tree(here_ / ("jobs" + jobs))) << jobs;
  }
  // Control: another seed gives other images.
  Succeeds({"render", "-o", "other", "--frames", "0:6", "--seed", "12345"});
  EXPECT_FALSE(Tree(here_ / "one" / "rgb") == Tree(here_ / "other" / "rgb"));
}

// Moving objects, which every thread places for its own frames.
TEST_F(DeterminismTest, MovingObjectsDoNotDependOnThreads) {
  const std::string scenario = (TinyScenario().parent_path() / "moving.yaml").string();
  const auto render = [&](const std::string& folder, const std::string& jobs) {
    Vobench({"render", scenario, "-o", folder, "--frames", "20:24", "--jobs", jobs, "--set",
             "sensor.rolling_shutter=10 ms", "--set",
             "camera={width: 160, height: 120, fx: 131.25, fy: 131.25, cx: 79.5, cy: 59.5}"});
  };
  render("one", "1");
  const auto one = Tree(here_ / "one");
  EXPECT_TRUE(one.contains("objects/parcel.txt"));
  for (const std::string jobs : {"2", "3", "8"}) {
    render("jobs" + jobs, jobs);
    EXPECT_TRUE(one == Tree(here_ / ("jobs" + jobs))) << jobs;
  }
  Vobench({"verify", "one"});
}

TEST_F(DeterminismTest, ARangeHasTheFramesOfTheWhole) {
  Succeeds({"render", "-o", "whole", "--frames", "0:8"});
  Succeeds({"render", "-o", "part", "--frames", "3:6"});
  Succeeds({"render", "-o", "alone", "--frames", "7:8"});
  for (const std::string folder : {"rgb", "depth"}) {
    const auto whole = Tree(here_ / "whole" / folder);
    for (const auto& [range, frames] : {std::pair<std::string, std::size_t>{"part", 3}, {"alone", 1}}) {
      const auto part = Tree(here_ / range / folder);
      ASSERT_EQ(part.size(), frames);
      for (const auto& [name, content] : part) {
        ASSERT_TRUE(whole.contains(name)) << name;
        EXPECT_TRUE(whole.at(name) == content) << name;
      }
    }
  }
  // The truth of a range is a substring of the truth of the whole.
  const std::string truth = Read("part/groundtruth.txt"), all = Read("whole/groundtruth.txt");
  const std::string lines = truth.substr(truth.find("\n0.") + 1);
  EXPECT_THAT(all, HasSubstr(lines));
}

TEST_F(DeterminismTest, RunsDoNotDependOnThreads) {
  const std::vector<std::string> run = {"run", "--system", "rb2pf,rbpf", "--runs", "2", "--set", "time.duration=0.3 s"};
  for (const std::string& jobs : kThreads) {
    std::vector<std::string> arguments = run;
    arguments.insert(arguments.end(), {"-o", "jobs" + jobs, "--jobs", jobs});
    Succeeds(arguments);
  }
  for (const std::string system : {"rb2pf", "rbpf"}) {
    for (const std::string seed : {"1", "2"}) {
      for (const std::string file : {"estimate.txt", "live.txt", "covariance.txt", "landmarks.csv", "truth.txt"}) {
        const std::string name = "/" + system + "/seed_" + seed + "/" + file;
        for (const std::string& jobs : kThreads)
          EXPECT_TRUE(Read("jobs1" + name) == Read("jobs" + jobs + name)) << name << ' ' << jobs;
      }
    }
  }
  EXPECT_FALSE(Read("jobs1/rb2pf/seed_1/estimate.txt") == Read("jobs1/rb2pf/seed_2/estimate.txt"));
}

// Points without images: each run has a world and a filter of its own seed.
TEST_F(DeterminismTest, RunsOnPointsDoNotDependOnThreads) {
  const std::string scene = (TinyScenario().parent_path() / "points.yaml").string();
  for (const std::string& jobs : kThreads) {
    Vobench({"run", scene, "--system", "rb2pf,rbpf", "--runs", "3", "--set", "time.duration=0.3 s", "-o", "jobs" + jobs,
             "--jobs", jobs});
  }
  for (const std::string system : {"rb2pf", "rbpf"}) {
    for (const std::string seed : {"1", "2", "3"}) {
      for (const std::string file : {"estimate.txt", "live.txt", "covariance.txt", "landmarks.csv", "truth.txt"}) {
        const std::string name = "/" + system + "/seed_" + seed + "/" + file;
        for (const std::string& jobs : kThreads)
          EXPECT_TRUE(Read("jobs1" + name) == Read("jobs" + jobs + name)) << name << ' ' << jobs;
      }
    }
  }
  EXPECT_TRUE(Read("jobs1/anees.csv") == Read("jobs2/anees.csv"));
  EXPECT_TRUE(Read("jobs1/rb2pf/seed_2/truth.txt") == Read("jobs1/rbpf/seed_2/truth.txt")) << "the same worlds for all";
  EXPECT_FALSE(Read("jobs1/rb2pf/seed_1/truth.txt") == Read("jobs1/rb2pf/seed_2/truth.txt"));
  // Alone, the second run is the same.
  Vobench({"run", scene, "--seed", "2", "--set", "time.duration=0.3 s", "-o", "alone"});
  EXPECT_TRUE(Read("jobs1/rb2pf/seed_2/estimate.txt") == Read("alone/rb2pf/seed_2/estimate.txt"));
}

// `track` has no truth; `run` without the truth gives the same bytes.
TEST_F(DeterminismTest, ThroughTheDiskOrInMemoryIsTheSame) {
  const std::string duration = "time.duration=0.3 s";
  Succeeds({"render", "-o", "seq", "--set", duration});
  Vobench({"track", "seq", "-o", "disk", "--seed", "3"});
  Succeeds({"run", "-o", "memory", "--seed", "3", "--set", duration, "--set",
            "prior={start: origin, velocity_sigma: 0.5, angular_rate_sigma: 0.5}"});
  for (const std::string file : {"estimate.txt", "live.txt", "covariance.txt", "landmarks.csv"}) {
    EXPECT_TRUE(Read("disk/" + file) == Read("memory/rb2pf/seed_3/" + file)) << file;
  }
  // Control: with the true start the estimate differs.
  Succeeds({"run", "-o", "told", "--seed", "3", "--set", duration});
  EXPECT_FALSE(Read("disk/estimate.txt") == Read("told/rb2pf/seed_3/estimate.txt"));
}

}  // namespace
}  // namespace vobench::system_test
