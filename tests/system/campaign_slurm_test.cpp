// A campaign through a real Slurm gives the table of one that ran here, whatever is killed in between.
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
  // Only what is missing is submitted.
  fs::remove_all(here_ / "slurm/tasks/00/000002");
  fs::remove_all(here_ / "slurm/tasks/00/000007");
  ASSERT_EQ(Run(Images(), "slurm", Slurm()).status, 0);
  EXPECT_EQ(ReadFile(here_ / "slurm/slurm/tasks.txt"), "2 7\n");
  EXPECT_TRUE(Lasting("slurm") == Lasting("local"));
  // What sbatch does not like is said in its words.
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
  // The one who waits: the jobs go on.
  EXPECT_TRUE(KillVobench(Words("slurm", Slurm()), here_.path(), [&] { return Done("slurm") >= 2; }));
  cluster.KillNodeDaemon();
  cluster.StartNode();
  // The node with all that runs on it, while somebody waits again.
  EXPECT_TRUE(KillVobench(Words("slurm", Slurm()), here_.path(), [&] { return Done("slurm") >= 8; }));
  cluster.KillNode();
  EXPECT_LT(Done("slurm"), 30u) << "nothing was left to be lost";
  cluster.StartNode();
  const Outcome outcome = Run(text, "slurm", Slurm());
  ASSERT_EQ(outcome.status, 0) << outcome.err << cluster.Log();
  EXPECT_THAT(outcome.err, HasSubstr("jobs of an earlier start (vobench-"));
  EXPECT_TRUE(Lasting("slurm") == Lasting("local"));
}

}  // namespace
}  // namespace vobench::system_test
