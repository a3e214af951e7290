// The twins of recordings (scenes/generate/twins.py) cross no surface of the rooms that they fly in.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/simulator.h"
#include "source_dir.h"
#include "tests/temporary_folder.h"

namespace sim {
namespace {

namespace fs = std::filesystem;

// Simulator's refusal of a path that passes through a surface; empty if it is accepted.
std::string Complaint(const fs::path& scenario, const std::string& path, const std::string& start_pose = "") {
  std::vector<std::pair<std::string, std::string>> changes = {{"trajectory.file", "'" + path + "'"},
                                                              {"render.light", "direct"}};
  if (!start_pose.empty()) changes.emplace_back("trajectory.start_pose", start_pose);
  try {
    Simulator(LoadScenario(scenario, changes), 1);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

class Twins : public testing::Test {
 protected:
  void SetUp() override {
    const char* data = std::getenv("VOBENCH_DATA");
    if (data == nullptr || !fs::exists(fs::path(data) / "trajectories"))
      GTEST_SKIP() << "no trajectories; set VOBENCH_DATA to the folder that holds trajectories/";
    const std::string command = "python3 '" VOBENCH_SOURCE_DIR "/scenes/generate/twins.py' '" + std::string(data) +
                                "' '" + paths_.path().string() + "' > /dev/null";
    ASSERT_EQ(std::system(command.c_str()), 0);
  }
  vobench_test::TemporaryFolder paths_;
  fs::path scenes_ = VOBENCH_SOURCE_DIR "/scenes/twins";
};

TEST_F(Twins, CrossNoSurface) {
  int count = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(scenes_)) {
    if (entry.path().extension() != ".yaml") continue;
    const std::string name = entry.path().stem().string();
    EXPECT_EQ(Complaint(entry.path(), (paths_ / (name + ".txt")).string()), "") << name;
    ++count;
  }
  EXPECT_EQ(count, 14);
}

TEST_F(Twins, ACrossingIsSeen) {
  const std::string path = (paths_ / "euroc_mh03.txt").string();
  EXPECT_NE(Complaint(scenes_ / "euroc_mh03.yaml", path, "{position: [15, 1.5, 13]}"), "");
}

}  // namespace
}  // namespace sim
