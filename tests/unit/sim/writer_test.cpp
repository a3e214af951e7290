#include "sim/sequence/writer.h"

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "sim/sequence/file_writer.h"
#include "sim/sequence/format.h"
#include "tests/unit/sim/small_world.h"

namespace sim {
namespace {

using testing::HasSubstr;

void Write(const Simulator& simulator, const std::filesystem::path& folder, std::int64_t first, std::int64_t last,
           int jobs) {
  SequenceWriter writer(simulator, folder, first, last, jobs, "test 1");
  std::int64_t written = 0;
  while (const std::int64_t batch = writer.WriteBatch()) written += batch;
  EXPECT_EQ(written, last - first);
  writer.Finish();
}

TEST(Format, TextsByHand) {
  EXPECT_EQ(FormatStamp(0), "0.000000000");
  EXPECT_EQ(FormatStamp(33333333), "0.033333333");
  EXPECT_EQ(FormatStamp(12000000001), "12.000000001");
  Truth truth;
  truth.p_WC = {1, -0.5, -1e-15};
  truth.v_WC = {0.25, 0, 0};
  truth.w_WC_C = {0, -2, 0};
  EXPECT_EQ(TruthLine(33333333, truth),
            "0.033333333 1.000000000000 -0.500000000000 0.000000000000 0.000000000000 0.000000000000 0.000000000000 "
            "1.000000000000\n");
  EXPECT_EQ(VelocityLine(0, truth),
            "0.000000000 0.250000000000 0.000000000000 0.000000000000 0.000000000000 -2.000000000000 0.000000000000\n");
}

TEST(Format, DepthIsInFifthsOfAMillimetre) {
  const std::vector<float> depth{0, 1, 2.00005f, 13.107f, 13.2f, 1e9f};
  const cv::Mat decoded = cv::imdecode(EncodeDepthPng(depth, 3, 2), cv::IMREAD_UNCHANGED);
  ASSERT_EQ(decoded.type(), CV_16UC1);
  EXPECT_EQ(decoded.at<std::uint16_t>(0, 0), 0);
  EXPECT_EQ(decoded.at<std::uint16_t>(0, 1), 5000);
  EXPECT_EQ(decoded.at<std::uint16_t>(0, 2), 10000);
  EXPECT_EQ(decoded.at<std::uint16_t>(1, 0), 65535);
  EXPECT_EQ(decoded.at<std::uint16_t>(1, 1), 0) << "beyond 13.1 m";
  EXPECT_EQ(decoded.at<std::uint16_t>(1, 2), 0);
}

TEST(SequenceWriter, WritesTheFormat) {
  const SmallWorld world;
  const Simulator simulator(LoadScenario(world.scenario()), 2);
  const auto folder = world.folder.path() / "new" / "sequence";
  Write(simulator, folder, 0, 9, 2);

  const auto tree = Tree(folder);
  EXPECT_EQ(tree.size(), 2u + 6u + 2 * 9u);
  EXPECT_THAT(
      tree.at("rgb.txt"),
      testing::StartsWith("# timestamp filename\n0.000000000 rgb/0.000000000.png\n0.033333333 rgb/0.033333333.png\n"));
  std::istringstream truth(tree.at("groundtruth.txt")), velocity(tree.at("velocity.txt"));
  std::string line;
  std::getline(truth, line);
  EXPECT_EQ(line, "# timestamp tx ty tz qx qy qz qw");
  std::getline(velocity, line);
  EXPECT_EQ(line, "# timestamp vx vy vz wx wy wz");
  for (std::int64_t k = 0; k < 9; ++k) {
    const Truth exact = simulator.TruthAt(k);
    double stamp = 0;
    glm::dvec3 p, v, w;
    glm::dquat q;
    truth >> stamp >> p.x >> p.y >> p.z >> q.x >> q.y >> q.z >> q.w;
    EXPECT_LT(glm::length(p - exact.p_WC), 1e-11);
    EXPECT_LT(glm::length(q - exact.q_WC), 1e-11);
    velocity >> stamp >> v.x >> v.y >> v.z >> w.x >> w.y >> w.z;
    EXPECT_LT(glm::length(v - exact.v_WC), 1e-11);
    EXPECT_LT(glm::length(w - exact.w_WC_C), 1e-11);

    const std::string name = FormatStamp(simulator.StampNs(k)) + ".png";
    const cv::Mat rgb = cv::imread((folder / "rgb" / name).string(), cv::IMREAD_UNCHANGED);
    const cv::Mat depth = cv::imread((folder / "depth" / name).string(), cv::IMREAD_UNCHANGED);
    ASSERT_EQ(rgb.type(), CV_8UC3);
    ASSERT_EQ(depth.type(), CV_16UC1);
    const Image image = simulator.Render(k).image;
    for (int c = 0; c < 3; ++c)
      EXPECT_EQ(rgb.at<cv::Vec3b>(10, 20)[2 - c], image.data[static_cast<std::size_t>(3 * (10 * 64 + 20) + c)]);
    EXPECT_NEAR(depth.at<std::uint16_t>(10, 20), 5000.0 * static_cast<double>(simulator.Depth(k)[10 * 64 + 20]), 0.51);
  }
  EXPECT_EQ(
      tree.at("camera.yaml"),
      "width: 64\nheight: 48\nfx: 52\nfy: 52\ncx: 31.5\ncy: 23.5\ndistortion: {k1: 0, k2: 0, p1: 0, p2: 0, k3: 0}\n");
  const auto manifest = nlohmann::json::parse(tree.at("manifest.json"));
  EXPECT_EQ(manifest["program"], "test 1");
  EXPECT_EQ(manifest["seed"], 5);
  EXPECT_EQ(manifest["frames"], 9);
  EXPECT_EQ(manifest["frame_range"], (nlohmann::json{0, 9}));
  EXPECT_EQ(manifest["camera"]["fx"], 52);
  EXPECT_EQ(manifest["scenario"]["sensor"]["time_samples"], 4);
}

TEST(SequenceWriter, TheSameBytesWithAnyJobsAndAnyRange) {
  const SmallWorld world;
  const Scenario scenario = LoadScenario(world.scenario());
  const Simulator simulator(scenario, 1), parallel(scenario, 3);
  Write(simulator, world.folder.path() / "one", 0, 9, 1);
  Write(parallel, world.folder.path() / "three", 0, 9, 3);
  Write(parallel, world.folder.path() / "part", 4, 7, 2);
  const auto one = Tree(world.folder.path() / "one");
  EXPECT_TRUE(one == Tree(world.folder.path() / "three"));
  const auto part = Tree(world.folder.path() / "part");
  EXPECT_EQ(part.size(), 2u + 6u + 2 * 3u);
  for (const auto& [name, bytes] : part) {
    if (!name.ends_with(".png")) continue;
    EXPECT_TRUE(one.at(name) == bytes) << name;
  }
  const std::string& truth = part.at("groundtruth.txt");
  EXPECT_THAT(one.at("groundtruth.txt"), HasSubstr(truth.substr(truth.find('\n') + 1)));
}

TEST(SequenceWriter, AnUnfinishedSequenceLeavesNothing) {
  const SmallWorld world;
  const Simulator simulator(LoadScenario(world.scenario()), 1);
  const auto before = Tree(world.folder.path());
  {
    SequenceWriter writer(simulator, world.folder.path() / "a" / "b" / "sequence", 0, 9, 1, "test");
    writer.WriteBatch();
    EXPECT_THROW(writer.Finish(), std::logic_error);
    EXPECT_FALSE(std::filesystem::exists(world.folder.path() / "a" / "b" / "sequence"));
  }
  EXPECT_TRUE(before == Tree(world.folder.path()));
}

TEST(SequenceWriter, RefusesWhatIsThereAndBadRanges) {
  const SmallWorld world;
  const Simulator simulator(LoadScenario(world.scenario()), 1);
  const auto make = [&](const std::filesystem::path& folder, std::int64_t first, std::int64_t last, int jobs) {
    SequenceWriter(simulator, folder, first, last, jobs, "test");
  };
  EXPECT_THROW(make(world.folder.path(), 0, 1, 1), std::runtime_error) << "not empty";
  EXPECT_THROW(make(world.scenario(), 0, 1, 1), std::runtime_error) << "a file";
  const auto folder = world.folder.path() / "out";
  for (const auto& [first, last] : {std::pair{0, 0}, {-1, 3}, {3, 2}, {0, 10}}) {
    EXPECT_THROW(make(folder, first, last, 1), std::invalid_argument) << first << ":" << last;
  }
  EXPECT_THROW(make(folder, 0, 1, 0), std::invalid_argument);
  try {
    make(world.scenario() / "below" / "a file", 0, 1, 1);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("wall.yaml/below/a file: cannot make this folder: Not a directory"));
  }
  EXPECT_FALSE(std::filesystem::exists(folder));
  std::filesystem::create_directory(folder);
  Write(simulator, folder, 0, 1, 1);
  EXPECT_TRUE(std::filesystem::exists(folder / "rgb.txt")) << "an empty folder is filled";
}

// Writing fails in the middle: a limit on the size of files stands for a full disk. One message that names a file,
// nothing left.
TEST(SequenceWriter, AFullDiskLeavesNothing) {
  const SmallWorld world;
  const Simulator simulator(LoadScenario(world.scenario()), 1);
  const auto before = Tree(world.folder.path());
  rlimit old{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &old), 0);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{700, old.rlim_max};
  std::string message;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  try {
    Write(simulator, world.folder.path() / "out" / "sequence", 0, 9, 2);
  } catch (const std::runtime_error& error) {
    message = error.what();
  }
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &old), 0);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_THAT(message, HasSubstr(".png: cannot be written: File too large"));
  EXPECT_TRUE(before == Tree(world.folder.path()));
}

TEST(FileWriter, SaysWhyItCannotWrite) {
  const TemporaryFolder folder;
  const auto message = [](const std::filesystem::path& path, const std::string& text) {
    try {
      WriteNewFile(path, text);
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  const auto file = folder.path() / "a.txt";
  EXPECT_EQ(message(file, "abc"), "no error");
  EXPECT_EQ(ReadWhole(file), "abc");
  EXPECT_EQ(message(file, "x"), file.string() + ": cannot be written: File exists");
  EXPECT_EQ(message(folder.path() / "none" / "a", "x"),
            (folder.path() / "none" / "a").string() + ": cannot be written: No such file or directory");
}

}  // namespace
}  // namespace sim
