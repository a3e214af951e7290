#include "sim/sequence/writer.h"

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "sim/sequence/content.h"
#include "sim/sequence/layout.h"
#include "tests/unit/sim/small_world.h"
#include "tools/base/files.h"
#include "tools/base/text.h"

namespace sim {
namespace {

using testing::HasSubstr;

using Start = SequenceWriter::Start;
namespace fs = std::filesystem;

SequenceContent Frames(std::int64_t first, std::int64_t last, Layout layout = Layout::tum) {
  return {layout, first, last, "test 1"};
}

void Write(const Simulator& simulator, const fs::path& folder, const SequenceContent& content, int jobs,
           Start start = Start::fresh) {
  SequenceWriter writer(simulator, folder, content, jobs, start);
  std::int64_t written = writer.found();
  while (const std::int64_t more = writer.Wait()) written += more;
  EXPECT_EQ(written, content.last - content.first);
  writer.Finish();
  fs::remove(folder / kJournalName);
}

void Write(const Simulator& simulator, const fs::path& folder, std::int64_t first, std::int64_t last, int jobs) {
  Write(simulator, folder, Frames(first, last), jobs);
}

std::string Refusal(const Simulator& simulator, const fs::path& folder, const SequenceContent& content) {
  try {
    SequenceWriter(simulator, folder, content, 1, Start::resume);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Format, TextsByHand) {
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

// 12-bit samples as the highest bits of 16.
TEST(Format, WideImagesKeepTheirWhite) {
  Image image;
  image.width = 2;
  image.height = 1;
  image.channels = 1;
  image.bits = 12;
  image.wide = {1, 4095};
  const cv::Mat decoded = cv::imdecode(EncodePng(image), cv::IMREAD_UNCHANGED);
  ASSERT_EQ(decoded.type(), CV_16UC1);
  EXPECT_EQ(decoded.at<std::uint16_t>(0, 0), 16);
  EXPECT_EQ(decoded.at<std::uint16_t>(0, 1), 65520);
}

TEST(SequenceWriter, WritesTheFormat) {
  const SmallWorld world;
  const Simulator simulator(LoadScenario(world.scenario()), 2);
  const auto folder = world.folder.path() / "new" / "sequence";
  Write(simulator, folder, 0, 9, 2);

  const auto tree = Tree(folder);
  EXPECT_EQ(tree.size(), 2u + 6u + 2 * 9u);
  EXPECT_THAT(tree.at("rgb.txt"),
              testing::StartsWith("# color images\n# made by vobench\n# timestamp filename\n0.000000000 "
                                  "rgb/0.000000000.png\n0.033333333 rgb/0.033333333.png\n"));
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

    const std::string name = base::FormatSeconds(simulator.StampNs(k)) + ".png";
    const cv::Mat rgb = cv::imread((folder / "rgb" / name).string(), cv::IMREAD_UNCHANGED);
    const cv::Mat depth = cv::imread((folder / "depth" / name).string(), cv::IMREAD_UNCHANGED);
    ASSERT_EQ(rgb.type(), CV_8UC3);
    ASSERT_EQ(depth.type(), CV_16UC1);
    const Image image = simulator.Render(k).image;
    for (int c = 0; c < 3; ++c)
      EXPECT_EQ(rgb.at<cv::Vec3b>(10, 20)[2 - c], image.data[static_cast<std::size_t>(3 * (10 * 64 + 20) + c)]);
    EXPECT_NEAR(depth.at<std::uint16_t>(10, 20), 5000.0 * static_cast<double>(simulator.Depth(k)[10 * 64 + 20]), 0.51);
  }
  EXPECT_EQ(tree.at("camera.yaml"),
            "width: 64\nheight: 48\nfx: 52\nfy: 52\ncx: 31.5\ncy: 23.5\ndistortion: {k1: 0, k2: 0, p1: 0, p2: 0, k3: "
            "0}\nrolling_shutter: 0 s\n");
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

TEST(SequenceWriter, AFrameIsAFunctionOfItsIndex) {
  const SmallWorld world;
  const Scenario scenario = LoadScenario(world.scenario());
  const Simulator forward(scenario, 1), backward(scenario, 2);
  std::map<std::int64_t, std::vector<JournalFile>> sums;
  for (std::int64_t k = 0; k < 9; ++k) sums[k] = Summed(FrameFiles(forward, Frames(0, 9), k));
  for (std::int64_t k = 8; k >= 0; --k) EXPECT_TRUE(Summed(FrameFiles(backward, Frames(3, 9), k)) == sums[k]) << k;
}

// Failure in the middle of writing: a limit on the size of files, between that of the lists and that of the images, in
// place of a full disk. One message with the name of a file; without a complete frame no file is left.
TEST(SequenceWriter, WithoutAFrameNothingIsLeft) {
  const SmallWorld world;
  const Simulator simulator(LoadScenario(world.scenario()), 1);
  Write(simulator, world.folder.path() / "whole", 0, 9, 1);
  std::size_t list = 0, image = 1u << 20;
  for (const auto& [name, bytes] : Tree(world.folder.path() / "whole")) {
    if (name.starts_with("rgb/")) image = std::min(image, bytes.size());
    if (!name.ends_with(".png")) list = std::max(list, bytes.size());
  }
  ASSERT_LT(list, image);
  const auto before = Tree(world.folder.path());
  rlimit old{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &old), 0);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{list, old.rlim_max};
  std::string message;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  try {
    Write(simulator, world.folder.path() / "a" / "b" / "sequence", 0, 9, 2);
  } catch (const std::runtime_error& error) {
    message = error.what();
  }
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &old), 0);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_THAT(message, HasSubstr(".png: cannot be written: File too large"));
  EXPECT_TRUE(before == Tree(world.folder.path()));
}

TEST(SequenceWriter, AutomaticExposuresAreThereInEveryLayout) {
  const SmallWorld world;
  const Simulator simulator(LoadScenario(world.scenario(), {{"sensor.auto_exposure", "{on: true, target: 0.4}"}}), 1);
  std::string expected = "# timestamp exposure gain\n";
  for (std::int64_t k = 2; k < 5; ++k) expected += ExposureLine(simulator.StampNs(k), simulator.SettingOf(k));
  for (const Layout layout : {Layout::tum, Layout::euroc, Layout::icl}) {
    const fs::path folder = world.folder.path() / ToString(layout);
    Write(simulator, folder, Frames(2, 5, layout), 1);
    const auto tree = Tree(folder);
    ASSERT_TRUE(tree.contains("exposure.txt")) << ToString(layout);
    EXPECT_EQ(tree.at("exposure.txt"), expected) << ToString(layout);
  }
}

TEST(SequenceWriter, IsNotFinishedWhileFramesAreLeft) {
  const SmallWorld world;
  const Simulator simulator(LoadScenario(world.scenario()), 1);
  SequenceWriter writer(simulator, world.folder.path() / "sequence", Frames(0, 9), 1, Start::fresh);
  if (writer.Stop() == 9) GTEST_SKIP() << "it was faster";
  EXPECT_THROW(writer.Finish(), std::logic_error);
}

// Stopped sequence: lists exactly its frames, and after resuming has the same bytes as one written in one go.
TEST(SequenceWriter, StopsAndResumes) {
  const SmallWorld world;
  const Simulator simulator(LoadScenario(world.scenario()), 2);
  for (const Layout layout : {Layout::tum, Layout::euroc, Layout::icl}) {
    const fs::path whole = world.folder.path() / ("whole_" + ToString(layout));
    const fs::path folder = world.folder.path() / ("stopped_" + ToString(layout));
    Write(simulator, whole, Frames(0, 9, layout), 2);
    std::int64_t frames = 0;
    {
      SequenceWriter writer(simulator, folder, Frames(0, 9, layout), 2, Start::fresh);
      while (frames < 3) frames += writer.Wait();
      frames = writer.Stop();
    }
    ASSERT_GE(frames, 2);
    auto left = Tree(folder);
    left.erase(kJournalName);
    if (frames < 9) {
      const fs::path prefix = world.folder.path() / ("prefix_" + ToString(layout));
      Write(simulator, prefix, Frames(0, frames, layout), 1);
      auto expected = Tree(prefix);
      EXPECT_EQ(nlohmann::json::parse(left.at("manifest.json"))["frames"], frames);
      EXPECT_EQ(nlohmann::json::parse(left.at("manifest.json"))["frame_range"], (nlohmann::json{0, 9}));
      left.erase("manifest.json");
      expected.erase("manifest.json");
      EXPECT_TRUE(left == expected) << ToString(layout);
    }
    Write(simulator, folder, Frames(0, 9, layout), 2, Start::resume);
    EXPECT_TRUE(Tree(folder) == Tree(whole)) << ToString(layout);
  }
}

// Damage after a kill or a loss of power: truncated, wrong and missing frames, unfinished files, a truncated or missing
// journal, truncated or missing lists.
TEST(SequenceWriter, ResumesFromDamage) {
  const SmallWorld world;
  const Simulator simulator(LoadScenario(world.scenario()), 2);
  const fs::path whole = world.folder.path() / "whole";
  Write(simulator, whole, 0, 9, 2);
  const auto expected = Tree(whole);
  const auto frame = [&](std::int64_t k) { return base::FormatSeconds(simulator.StampNs(k)) + ".png"; };
  const std::vector<std::pair<std::string, std::function<void(const fs::path&)>>> damages = {
      {"truncated", [&](const fs::path& f) { fs::resize_file(f / "rgb" / frame(8), 100); }},
      {"empty", [&](const fs::path& f) { fs::resize_file(f / "depth" / frame(7), 0); }},
      {"other bytes",
       [&](const fs::path& f) {
         std::fstream file(f / "rgb" / frame(3), std::ios::in | std::ios::out | std::ios::binary);
         file.seekp(60);
         file << "xxxx";
       }},
      {"missing", [&](const fs::path& f) { fs::remove(f / "depth" / frame(0)); }},
      {"strays",
       [&](const fs::path& f) {
         std::ofstream(f / "rgb" / base::UnfinishedName(frame(8))) << "half";
         std::ofstream(f / base::UnfinishedName("rgb.txt")) << "half";
       }},
      {"torn journal",
       [&](const fs::path& f) { fs::resize_file(f / kJournalName, fs::file_size(f / kJournalName) - 20); }},
      {"no journal", [&](const fs::path& f) { fs::remove(f / kJournalName); }},
      {"torn lists", [&](const fs::path& f) { fs::resize_file(f / "rgb.txt", 70); }},
      {"no lists", [&](const fs::path& f) { fs::remove(f / "groundtruth.txt"); }},
      {"nothing but a torn manifest",
       [&](const fs::path& f) {
         fs::remove_all(f);
         fs::create_directory(f);
         std::ofstream(f / base::UnfinishedName("manifest.json")) << "{";
       }},
      {"nothing", [&](const fs::path& f) { fs::remove_all(f); }},
  };
  for (const auto& [name, damage] : damages) {
    const fs::path folder = world.folder.path() / "damaged";
    fs::remove_all(folder);
    {
      SequenceWriter writer(simulator, folder, Frames(0, 9), 2, Start::fresh);
      while (writer.Wait() > 0) {
      }
      writer.Finish();
    }
    const auto before = Tree(folder);
    damage(folder);
    ASSERT_FALSE(fs::exists(folder) && Tree(folder) == before) << name;
    Write(simulator, folder, Frames(0, 9), 2, Start::resume);
    EXPECT_TRUE(Tree(folder) == expected) << name;
  }
}

TEST(SequenceWriter, ResumesOnlyTheSame) {
  const SmallWorld world;
  const Scenario scenario = LoadScenario(world.scenario());
  const Simulator simulator(scenario, 1);
  const fs::path folder = world.folder.path() / "sequence";
  {
    SequenceWriter writer(simulator, folder, Frames(0, 9), 1, Start::fresh);
    writer.Wait();
  }
  const auto before = Tree(folder);
  const Simulator other(LoadScenario(world.scenario(), {{"sensor.exposure", "2 ms"}, {"seed", "7"}}), 1);
  const std::string refusal = Refusal(other, folder, Frames(0, 9));
  EXPECT_THAT(refusal, HasSubstr("scenario.sensor.exposure is 0.01 there, not 0.002"));
  EXPECT_THAT(refusal, HasSubstr("seed is 5 there, not 7"));
  EXPECT_THAT(Refusal(simulator, folder, Frames(0, 8)), HasSubstr("frame_range.1 is 9 there, not 8"));
  EXPECT_THAT(Refusal(simulator, folder, {Layout::tum, 0, 9, "test 2"}),
              HasSubstr("program is \"test 1\" there, not \"test 2\""));
  EXPECT_THAT(Refusal(simulator, folder, Frames(0, 9, Layout::icl)), HasSubstr("layout is \"tum\" there"));
  EXPECT_TRUE(Tree(folder) == before) << "a refusal touches nothing";
  // Other colours of the wall under the same file name.
  std::string ply = WallPly();
  ply.replace(ply.rfind(" -2 ") + 4, 2, "77");
  for (std::size_t at = 0; (at = ply.find(" -2 1", at)) != std::string::npos; at += 5) ply[at + 4] = '2';
  world.folder.Write("wall.ply", ply);
  const Simulator repainted(scenario, 1);
  EXPECT_THAT(Refusal(repainted, folder, Frames(0, 9)), HasSubstr("does not come out the same again"));
  EXPECT_TRUE(Tree(folder) == before);
  EXPECT_EQ(Refusal(simulator, folder, Frames(0, 9)), "accepted");
  fs::remove(folder / "manifest.json");
  EXPECT_THAT(Refusal(simulator, folder, Frames(0, 9)), HasSubstr("manifest.json: is not there"));
  std::ofstream(folder / "manifest.json") << "{\"seed\": ";
  EXPECT_THAT(Refusal(simulator, folder, Frames(0, 9)), HasSubstr("manifest.json: is not a JSON object"));
}

TEST(SequenceWriter, OneProcessAtATime) {
  const SmallWorld world;
  const Simulator simulator(LoadScenario(world.scenario()), 1);
  const fs::path folder = world.folder.path() / "sequence";
  const SequenceWriter writer(simulator, folder, Frames(0, 9), 1, Start::fresh);
  try {
    SequenceWriter(simulator, folder, Frames(0, 9), 1, Start::resume);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("another process is writing it"));
  }
}

TEST(SequenceWriter, RefusesWhatIsThereAndBadRanges) {
  const SmallWorld world;
  const Simulator simulator(LoadScenario(world.scenario()), 1);
  const auto make = [&](const fs::path& folder, std::int64_t first, std::int64_t last, int jobs) {
    SequenceWriter(simulator, folder, Frames(first, last), jobs, Start::fresh);
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
    EXPECT_THAT(error.what(), testing::AllOf(HasSubstr("wall.yaml/below/a file: "), HasSubstr("Not a directory")));
  }
  EXPECT_FALSE(fs::exists(folder));
  fs::create_directory(folder);
  Write(simulator, folder, 0, 1, 1);
  EXPECT_TRUE(fs::exists(folder / "rgb.txt")) << "an empty folder is filled";
}

TEST(SequenceWriter, RefusesWhatALayoutCannotSay) {
  const SmallWorld world;
  const Simulator fast(LoadScenario(world.scenario(), {{"time.rate", "60 Hz"}, {"sensor.exposure", "5 ms"}}), 1);
  EXPECT_THAT(Refusal(fast, world.folder.path() / "a", Frames(0, 9, Layout::icl)), HasSubstr("time.rate = 60 Hz"));
  const Simulator lens(LoadScenario(world.scenario(), {{"camera.distortion.k3", "0.01"}}), 1);
  EXPECT_THAT(Refusal(lens, world.folder.path() / "a", Frames(0, 9, Layout::euroc)), HasSubstr("k3 = 0.01"));
}

}  // namespace
}  // namespace sim
