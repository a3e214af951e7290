// The twins of recordings (scenes/generate/twins.py) cross no surface of the rooms that they fly in.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "sim/render/surface_tracer.h"
#include "sim/simulator.h"
#include "source_dir.h"
#include "tests/temporary_folder.h"

namespace sim {
namespace {

namespace fs = std::filesystem;

// How many pieces of the path, 1/120 s each, meet a surface.
int Crossings(const fs::path& scenario, const std::string& path, const std::string& start_pose = "") {
  std::vector<std::pair<std::string, std::string>> changes = {{"trajectory.file", "'" + path + "'"},
                                                              {"render.light", "direct"}};
  if (!start_pose.empty()) changes.emplace_back("trajectory.start_pose", start_pose);
  const Simulator simulator(LoadScenario(scenario, changes), 1);
  const double end_s = Seconds(simulator.StampNs(simulator.frame_count() - 1));
  int crossings = 0;
  std::vector<std::uint8_t> visible;
  glm::dvec3 last = simulator.trajectory().At(0).pose.p_WC;
  for (double t = 1.0 / 120; t <= end_s; t += 1.0 / 120) {
    const glm::dvec3 here = simulator.trajectory().At(t).pose.p_WC;
    // Long enough that a surface is not taken for the end's own.
    const glm::dvec3 ahead = here + 1e-3 * glm::normalize(here - last + glm::dvec3(1e-12));
    simulator.surfaces().Visible(View({last, {}}, t), std::vector{ahead}, visible);
    crossings += visible[0] == 0;
    last = here;
  }
  return crossings;
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
    EXPECT_EQ(Crossings(entry.path(), (paths_ / (name + ".txt")).string()), 0) << name;
    ++count;
  }
  EXPECT_EQ(count, 14);
}

TEST_F(Twins, ACrossingIsSeen) {
  const std::string path = (paths_ / "euroc_mh03.txt").string();
  EXPECT_GT(Crossings(scenes_ / "euroc_mh03.yaml", path, "{position: [15, 1.5, 13]}"), 0);
}

}  // namespace
}  // namespace sim
