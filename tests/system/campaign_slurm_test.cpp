// Campaign on a real Slurm: the table of a local campaign, also after kills.
#include <algorithm>

#include "tests/system/campaign.h"
#include "tests/system/slurm_cluster.h"

namespace vobench::system_test {
namespace {
namespace fs = std::filesystem;
using testing::HasSubstr;

class CampaignSlurmTest : public CampaignTest {
 protected:
  void SetUp() override {
    const std::string why_not = SlurmCluster::WhyNot();
    if (!why_not.empty()) GTEST_SKIP() << why_not;
  }
  static std::vector<std::string> Slurm(std::vector<std::string> more = {}) {
    more.insert(more.begin(), {"--engine", "slurm", "--tasks-per-job", "10"});
    return more;
  }
};

TEST_F(CampaignSlurmTest, TheTableIsThatOfALocalCampaign) {
  MustRun(Images(), "local");
  const SlurmCluster cluster;
  const Outcome outcome = Run(Images(), "slurm", Slurm({"--partition", "all", "--time", "5", "--timeout", "100"}));
  ASSERT_EQ(outcome.status, 0) << outcome.err << cluster.Log();
  EXPECT_TRUE(Lasting("slurm") == Lasting("local"));
  EXPECT_THAT(ReadFile(here_ / "slurm/slurm/job.sh"), HasSubstr("#SBATCH --partition=all\n#SBATCH --time=5\n"));
  // Only missing tasks are submitted.
  fs::remove_all(here_ / "slurm/tasks/00/000002");
  fs::remove_all(here_ / "slurm/tasks/00/000007");
  ASSERT_EQ(Run(Images(), "slurm", Slurm()).status, 0);
  EXPECT_EQ(ReadFile(here_ / "slurm/slurm/tasks.txt"), "2 7\n");
  EXPECT_TRUE(Lasting("slurm") == Lasting("local"));
  // Errors of sbatch are passed on.
  const Outcome refused = Run(Images(), "other", Slurm({"--partition", "none"}));
  EXPECT_EQ(refused.status, 1);
  EXPECT_THAT(refused.err, HasSubstr("sbatch: "));
  EXPECT_THAT(refused.err, HasSubstr("nvalid partition"));
}

TEST_F(CampaignSlurmTest, TheCampaignTheDaemonAndTheNodeAreKilled) {
  std::string text = Points();
  text.replace(text.find("2 s"), 3, "6 s");  // jobs of some seconds
  MustRun(text, "local");
  SlurmCluster cluster;
  WriteFile(here_ / "c.yaml", text);
  // SIGKILL for the waiting campaign: its jobs go on.
  EXPECT_TRUE(KillVobench(Words("slurm", Slurm()), here_.path(), [&] { return Done("slurm") >= 2; }));
  cluster.KillNodeDaemon();
  cluster.StartNode();
  // SIGKILL for the campaign, then for the node with all its processes.
  EXPECT_TRUE(KillVobench(Words("slurm", Slurm()), here_.path(), [&] { return Done("slurm") >= 8; }));
  cluster.KillNode();
  EXPECT_LT(Done("slurm"), 30u) << "nothing was left to be lost";
  cluster.StartNode();
  const Outcome outcome = Run(text, "slurm", Slurm());
  ASSERT_EQ(outcome.status, 0) << outcome.err << cluster.Log();
  EXPECT_THAT(outcome.err, HasSubstr("jobs of an earlier start (vobench-"));
  EXPECT_TRUE(Lasting("slurm") == Lasting("local"));
}

// Slurm controller out of reach: the jobs may be in its queue, so none is submitted.
TEST_F(CampaignTest, SubmitsNothingIntoAnUnknownQueue) {
  const auto command = [&](const std::string& name, const std::string& script) {
    WriteFile(here_ / ("bin/" + name), "#!/bin/sh\n" + script);
    fs::permissions(here_ / ("bin/" + name), fs::perms::owner_all);
  };
  const std::string asked = (here_ / "asked").string();
  command("squeue", "test -e " + asked + " && exit 0; touch " + asked +
                        ";  echo 'slurm_load_jobs error: Unable to contact slurm controller' >&2; exit 1\n");
  command("sbatch", "touch " + (here_ / "submitted").string() + "\n");
  WriteFile(here_ / "c.yaml", Points());
  const auto run = [&] {
    return RunVobench(Words("out", {"--engine", "slurm"}), here_.path(),
                      "PATH=" + Quoted((here_ / "bin").string()) + ":$PATH; export PATH");
  };
  const Outcome outcome = run();
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, HasSubstr("squeue"));
  EXPECT_THAT(outcome.err, HasSubstr("slurm_load_jobs error: Unable to"));
  EXPECT_FALSE(fs::exists(here_ / "submitted"));
  EXPECT_THAT(run().err, HasSubstr("no result from Slurm in 3 rounds")) << "of a queue that is known to be empty";
  EXPECT_TRUE(fs::exists(here_ / "submitted"));
}

}  // namespace
}  // namespace vobench::system_test
