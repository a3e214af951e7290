// Labels: names and classes of a world's entries, instances and classes of pixels, boxes in the picture and in space.
#include "sim/world/labels.h"

#include <gmock/gmock.h>

#include <map>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "sim/sequence/streams.h"
#include "tests/unit/sim/small_world.h"
#include "tools/base/settings/settings.h"

namespace sim {
namespace {

// SmallWorld's wall, a copy of half its size in front of its left half, a visible lamp, and a moving board.
Scenario Labelled(const SmallWorld& world) {
  return LoadScenario(
      world.scenario(),
      {{"world.meshes", "[{file: wall.ply, class: building}, {file: wall.ply, scale: 0.5, position: [-0.8, 0, 0]}]"},
       {"world.objects",
        "[{name: board, class: sign, file: wall.ply, scale: 0.1, position: [0, 0, -0.7], orientation: [0, 0, 0.6, 0.8],"
        "trajectory: {type: dolly, start: {position: [0.2, 0.1, 0]}, move: [0.3, 0, 0], period: 0.6 s}}]"},
       {"world.lights",
        "[{type: ambient, radiance: [1, 1, 1]}, {type: rectangle, corner: [0.4, 0.4, -1.5], side_u: [0.3, 0, 0],"
        "side_v: [0, 0.2, 0], radiance: [1, 1, 1], visible: true}]"}});
}

TEST(Labels, NamesClassesAndBoxesOfEntries) {
  const SmallWorld world;
  const Simulator simulator(Labelled(world), 1);
  const std::string& resolved = simulator.scenario().resolved;
  EXPECT_EQ(LoadScenario(world.folder.Write("again.yaml", resolved)).resolved, resolved);
  const Labels& labels = simulator.labels();
  ASSERT_EQ(labels.instances.size(), 4u);
  const auto texts = [](const Instance& i) { return i.name + " " + i.category + " " + i.entry; };
  EXPECT_EQ(texts(labels.instances[0]), "wall building world.meshes.0");
  EXPECT_EQ(texts(labels.instances[1]), "wall_2 wall world.meshes.1");
  EXPECT_EQ(texts(labels.instances[2]), "lamp lamp world.lights.1");
  EXPECT_EQ(texts(labels.instances[3]), "board sign world.objects.0");
  EXPECT_THAT(labels.classes, testing::ElementsAre("building", "lamp", "sign", "wall"));
  const auto expect = [](const Instance& i, const glm::dvec3& middle, const glm::dvec3& size) {
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(i.box.p_WC[axis], middle[axis], 1e-6) << i.name;
      EXPECT_NEAR(i.size[axis], size[axis], 1e-6) << i.name;
    }
  };
  expect(labels.instances[0], {0, 0, -2}, {4, 3, 0});
  expect(labels.instances[1], {-0.8, 0, -1}, {2, 1.5, 0});
  expect(labels.instances[2], {0.55, 0.5, -1.5}, {0.3, 0.2, 0});
  expect(labels.instances[3], {0, 0, -0.9}, {0.4, 0.3, 0});  // along its own axes, which are turned
}

TEST(Labels, PicturesAndBoxesAgree) {
  const SmallWorld world;
  const Simulator simulator(Labelled(world), 1), parallel(Labelled(world), 3);
  const Labels& labels = simulator.labels();
  const std::set<TruthStream> streams = {TruthStream::instance, TruthStream::semantic, TruthStream::boxes,
                                         TruthStream::surface_id};
  std::map<std::string, std::vector<std::uint8_t>> files, again;
  for (const StreamFile& file : FrameStreams(simulator, 4, streams)) files[file.path] = file.bytes;
  for (const StreamFile& file : FrameStreams(parallel, 4, streams)) again[file.path] = file.bytes;
  EXPECT_TRUE(files == again);
  const cv::Mat ids = cv::imdecode(files.at("instance/0.133333333.png"), cv::IMREAD_UNCHANGED),
                classes = cv::imdecode(files.at("semantic/0.133333333.png"), cv::IMREAD_UNCHANGED),
                surfaces = cv::imdecode(files.at("surface_id/0.133333333.png"), cv::IMREAD_UNCHANGED);
  ASSERT_EQ(ids.type(), CV_16UC1);
  ASSERT_EQ(classes.type(), CV_8UC1);
  std::map<int, cv::Rect> boxes;
  std::map<int, int> pixels;
  for (int y = 0; y < ids.rows; ++y) {
    for (int x = 0; x < ids.cols; ++x) {
      const std::uint16_t id = ids.at<std::uint16_t>(y, x);
      ASSERT_EQ(id, surfaces.at<std::uint16_t>(y, x)) << "one mesh each, in this order";
      ASSERT_EQ(classes.at<std::uint8_t>(y, x), id == 0 ? 0 : labels.ClassId(labels.instances[id - 1U]));
      if (id == 0) continue;
      boxes[id] = boxes.contains(id) ? boxes[id] | cv::Rect(x, y, 1, 1) : cv::Rect(x, y, 1, 1);
      ++pixels[id];
    }
  }
  ASSERT_EQ(boxes.size(), 4u) << "all four are seen";
  const auto& csv = files.at("boxes/0.133333333.csv");
  std::istringstream lines(std::string(csv.begin(), csv.end()));
  std::string line;
  std::getline(lines, line);
  for (int id = 1; id <= 4; ++id) {
    ASSERT_TRUE(std::getline(lines, line));
    const cv::Rect& box = boxes.at(id);
    const std::string expected =
        std::to_string(id) + "," + std::to_string(labels.ClassId(labels.instances[static_cast<std::size_t>(id - 1)])) +
        "," + std::to_string(box.x) + "," + std::to_string(box.y) + "," + std::to_string(box.x + box.width - 1) + "," +
        std::to_string(box.y + box.height - 1) + "," + std::to_string(pixels.at(id)) + ",";
    EXPECT_THAT(line, testing::StartsWith(expected));
  }
  EXPECT_FALSE(std::getline(lines, line));
}

// Projected corners of the board's box against the bounds of its pixels, to one pixel.
TEST(Labels, TheBoxInSpaceIsTheOneInThePicture) {
  const SmallWorld world;
  const Simulator simulator(Labelled(world), 1);
  for (const std::int64_t index : {0, 4, 8}) {
    std::vector<StreamFile> files = FrameStreams(simulator, index, {TruthStream::boxes});
    const std::string text(files.at(0).bytes.begin(), files.at(0).bytes.end());
    std::istringstream last(text.substr(text.rfind("\n4,") + 1));
    double n[17];
    for (double& number : n) {
      std::string word;
      std::getline(last, word, ',');
      number = std::stod(word);
    }
    glm::dvec2 low(1e9), high(-1e9);
    for (int corner = 0; corner < 4; ++corner) {
      const glm::dvec3 X(n[14] * (corner % 2 - 0.5), n[15] * (corner / 2 - 0.5), 0);
      const glm::dvec2 pixel =
          simulator.camera().Project(glm::dvec3(n[7], n[8], n[9]) + glm::dquat(n[13], n[10], n[11], n[12]) * X);
      low = glm::min(low, pixel);
      high = glm::max(high, pixel);
    }
    low = glm::max(low, glm::dvec2(0));  // clipped at the image's border
    high = glm::min(high, glm::dvec2(63, 47));
    EXPECT_TRUE(n[2] - low.x >= 0 && n[2] - low.x <= 1 && n[3] - low.y >= 0 && n[3] - low.y <= 1)
        << index << ": " << n[2] - low.x << " " << n[3] - low.y;
    EXPECT_TRUE(high.x - n[4] >= 0 && high.x - n[4] <= 1 && high.y - n[5] >= 0 && high.y - n[5] <= 1)
        << index << ": " << high.x - n[4] << " " << high.y - n[5];
  }
}

TEST(Labels, TheLegendLeadsToTheScenario) {
  const SmallWorld world;
  const Simulator simulator(Labelled(world), 1);
  std::string legend;
  for (const StreamFile& file : SequenceStreams(simulator, 0, 9, {TruthStream::semantic})) {
    if (file.path == "labels.json") legend.assign(file.bytes.begin(), file.bytes.end());
  }
  const auto json = nlohmann::json::parse(legend), resolved = nlohmann::json::parse(simulator.scenario().resolved);
  for (const auto& instance : json.at("instances")) {
    std::string pointer = "/" + instance.at("scenario").get<std::string>();
    std::ranges::replace(pointer, '.', '/');
    EXPECT_TRUE(resolved.contains(nlohmann::json::json_pointer(pointer))) << pointer;
    EXPECT_EQ(json.at("classes").at(instance.at("class_id").get<std::size_t>() - 1).at("name"), instance.at("class"));
  }
  EXPECT_TRUE(StreamNames().contains("labels.json"));
}

TEST(Labels, NamesThatAreTakenAreErrors) {
  const SmallWorld world;
  for (const char* meshes : {"[{file: wall.ply, name: a}, {file: wall.ply, name: a}]", "[{file: wall.ply, name: ''}]"})
    EXPECT_THROW(LoadScenario(world.scenario(), {{"world.meshes", meshes}}), settings::Error) << meshes;
  const Scenario scenario = LoadScenario(
      world.scenario(), {{"world.meshes", "[{file: wall.ply}, {file: wall.ply}, {file: wall.ply, name: wall_2}]"}});
  EXPECT_EQ(scenario.world.meshes[0].name, "wall");
  EXPECT_EQ(scenario.world.meshes[1].name, "wall_3");
}

}  // namespace
}  // namespace sim
