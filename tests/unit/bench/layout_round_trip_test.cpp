// Sequence of the simulator in each layout, through the odometry's reader, the camera's and the judge's: stamps,
// pixels, poses.
#include <gmock/gmock.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <opencv2/imgproc.hpp>
#include <sstream>

#include "sim/sequence/writer.h"
#include "tests/unit/sim/small_world.h"
#include "tools/bench/sequence/sequence_truth.h"
#include "tools/bench/systems/bridge.h"
#include "vo/geometry/camera.h"
#include "vo/geometry/camera_file.h"
#include "vo/sequence/reader.h"

namespace vobench {
namespace {
namespace fs = std::filesystem;

fs::path Written(const sim::SmallWorld& world, const sim::Simulator& simulator, sim::Layout layout) {
  const fs::path folder = world.folder.path() / sim::ToString(layout);
  sim::SequenceWriter writer(simulator, folder, {layout, 2, 9, "test"}, 2, sim::SequenceWriter::Start::fresh);
  while (writer.Wait() > 0) {
  }
  writer.Finish();
  return folder;
}

class LayoutRoundTrip : public testing::TestWithParam<sim::Layout> {};

TEST_P(LayoutRoundTrip, StampsImagesAndPosesAreThoseOfTheSimulator) {
  const sim::SmallWorld world;
  const sim::Simulator simulator(sim::LoadScenario(world.scenario()), 2);
  const fs::path folder = Written(world, simulator, GetParam());
  vo::SequenceReader reader(folder);
  const std::optional<Truth> truth = ReadSequenceTruth(folder);
  ASSERT_TRUE(truth);
  ASSERT_EQ(reader.size(), 7u);
  ASSERT_EQ(truth->poses.size(), 7u);
  for (std::int64_t k = 2; k < 9; ++k) {
    const sim::Frame frame = simulator.Render(k);
    const auto read = reader.Next();
    ASSERT_TRUE(read);
    EXPECT_EQ(read->stamp_ns, frame.stamp_ns);
    cv::Mat rgb;
    cv::cvtColor(read->image, rgb, cv::COLOR_BGR2RGB);
    ASSERT_EQ(rgb.total() * 3, frame.image.data.size());
    EXPECT_TRUE(std::equal(frame.image.data.begin(), frame.image.data.end(), rgb.data)) << "frame " << k;

    const evaluation::StampedPose& pose = truth->poses[static_cast<std::size_t>(k - 2)];
    const sim::Truth& exact = frame.truth;
    EXPECT_EQ(pose.stamp_ns, frame.stamp_ns);
    EXPECT_LT((pose.p_WC - Eigen::Vector3d(exact.p_WC.x, exact.p_WC.y, exact.p_WC.z)).norm(), 1e-11);
    const Eigen::Quaterniond q(exact.q_WC.w, exact.q_WC.x, exact.q_WC.y, exact.q_WC.z);
    EXPECT_LT(pose.q_WC.angularDistance(q), 1e-11);
  }
}

INSTANTIATE_TEST_SUITE_P(All, LayoutRoundTrip, testing::Values(sim::Layout::tum, sim::Layout::euroc, sim::Layout::icl),
                         [](const auto& instance) { return sim::ToString(instance.param); });

// Frames from memory and from file: the same bytes at every depth of the converter.
TEST(DeepSequences, AreReadAsTheyAreHandedOver) {
  for (const int bits : {8, 9, 12, 16}) {
    const sim::SmallWorld world;
    const sim::Simulator simulator(sim::LoadScenario(world.scenario(), {{"sensor.bit_depth", std::to_string(bits)}}),
                                   2);
    vo::SequenceReader reader(Written(world, simulator, sim::Layout::tum));
    for (std::int64_t k = 2; k < 9; ++k) {
      const vo::Frame handed = ToOdometry(simulator.Render(k));
      const std::optional<vo::Frame> read = reader.Next();
      ASSERT_TRUE(read);
      ASSERT_EQ(read->image.type(), CV_8UC3);
      EXPECT_EQ(cv::norm(read->image, handed.image, cv::NORM_INF), 0) << bits << " bits, frame " << k;
      EXPECT_GT(cv::norm(read->image, cv::NORM_INF), 100) << "it is not dark";
    }
  }
}

TEST(EurocLayout, HasTheCameraWithItsLens) {
  const sim::SmallWorld world;
  const sim::Simulator simulator(
      sim::LoadScenario(world.scenario(), {{"camera.distortion", "{k1: -0.05, k2: 0.01, p1: 0.001, p2: -0.002}"},
                                           {"camera.fy", "50.25"}}),
      2);
  const fs::path folder = Written(world, simulator, sim::Layout::euroc);
  const vo::Camera of_sensor = vo::ReadCamera(folder / "mav0/cam0/sensor.yaml");
  const vo::Camera own = vo::ReadCamera(folder / "camera.yaml");
  for (const vo::Camera& camera : {of_sensor, own}) {
    EXPECT_EQ(camera.width, 64);
    EXPECT_EQ(camera.height, 48);
    EXPECT_EQ(camera.fx, 52);
    EXPECT_EQ(camera.fy, 50.25);
    EXPECT_EQ(camera.cx, 31.5);
    EXPECT_EQ(camera.cy, 23.5);
    EXPECT_EQ(camera.k1, -0.05);
    EXPECT_EQ(camera.k2, 0.01);
    EXPECT_EQ(camera.p1, 0.001);
    EXPECT_EQ(camera.p2, -0.002);
    EXPECT_EQ(camera.k3, 0);
  }
}

TEST(EurocLayout, NamesAFisheyeLensAsKalibrDoes) {
  sim::Scenario scenario;
  scenario.camera.lens = sim::Lens::fisheye;
  scenario.camera.k1 = 0.1;
  scenario.camera.k2 = -0.2;
  scenario.camera.k3 = 0.3;
  scenario.camera.k4 = -0.4;
  EXPECT_TRUE(sim::Problems(sim::Layout::euroc, scenario).empty());
  int found = 0;
  for (const sim::StreamFile& file : sim::Lists(sim::Layout::euroc, scenario, {})) {
    if (file.path != "mav0/cam0/sensor.yaml") continue;
    ++found;
    const sim::TemporaryFolder folder;
    const vo::Camera read =
        vo::ReadCamera(folder.Write("sensor.yaml", std::string(file.bytes.begin(), file.bytes.end())));
    EXPECT_EQ(read.lens, vo::Lens::fisheye);
    EXPECT_EQ(read.k1, 0.1);
    EXPECT_EQ(read.k2, -0.2);
    EXPECT_EQ(read.k3, 0.3);
    EXPECT_EQ(read.k4, -0.4);
    EXPECT_THAT(std::string(file.bytes.begin(), file.bytes.end()),
                testing::EndsWith("distortion_model: equidistant\ndistortion_coefficients: [0.1, -0.2, 0.3, -0.4]\n"));
  }
  EXPECT_EQ(found, 1);
}

// Numbers of a line, by hand: EuRoC has w first, and the biases of an absent sensor are 0.
TEST(EurocLayout, TruthByHand) {
  sim::Scenario scenario;
  sim::StampedTruth frame;
  frame.stamp_ns = 33333333;
  frame.truth.p_WC = {1, 2, 3};
  frame.truth.q_WC = {0.8, 0.2, -0.4, 0.4};  // w x y z
  frame.truth.v_WC = {4, 5, 6};
  std::vector<sim::StreamFile> files = sim::Lists(sim::Layout::euroc, scenario, std::span(&frame, 1));
  for (sim::StreamFile& file : sim::BodyLists(sim::Layout::euroc, scenario, std::span(&frame, 1)))
    files.push_back(std::move(file));
  int found = 0;
  for (const sim::StreamFile& file : files) {
    const std::string text(file.bytes.begin(), file.bytes.end());
    const std::string last = text.substr(text.rfind('\n', text.size() - 2) + 1);
    if (file.path == "mav0/cam0/data.csv") {
      EXPECT_EQ(last, "33333333,33333333.png\n");
      ++found;
    }
    if (file.path == "mav0/state_groundtruth_estimate0/data.csv") {
      EXPECT_EQ(last,
                "33333333,1.000000000000,2.000000000000,3.000000000000,0.800000000000,0.200000000000,-0.400000000000,"
                "0.400000000000,4.000000000000,5.000000000000,6.000000000000,0.000000000000,0.000000000000,"
                "0.000000000000,0.000000000000,0.000000000000,0.000000000000\n");
      ++found;
    }
  }
  EXPECT_EQ(found, 2);
}

// An IMU 0.1 m to the right of the camera and turned by 90 degrees about its x; streams that EuRoC has no place for.
TEST(EurocLayout, HasTheImuWithItsPlaceAndItsBiases) {
  const sim::SmallWorld world;
  sim::Scenario scenario = sim::LoadScenario(
      world.scenario(),
      {{"truth", "[depth, imu, flow]"},
       {"imu",
        "{rate: 200 Hz, position: [0.1, 0, 0], orientation: [0.7071067811865476, 0, 0, 0.7071067811865476], "
        "gyroscope_walk: 0.01, accelerometer_walk: 0.1, gyroscope_noise: 0.001}"}});
  const sim::Simulator simulator(scenario, 1);
  const fs::path folder = Written(world, simulator, sim::Layout::euroc);
  EXPECT_FALSE(fs::exists(folder / "imu0"));
  EXPECT_FALSE(fs::exists(folder / "truth/depth"));
  EXPECT_TRUE(fs::exists(folder / "truth/flow.txt"));
  const auto text = [&](const char* name) {
    std::ifstream stream(folder / name);
    return std::string(std::istreambuf_iterator<char>(stream), {});
  };
  const YAML::Node imu = YAML::Load(text("mav0/imu0/sensor.yaml"));
  const YAML::Node camera = YAML::Load(text("mav0/cam0/sensor.yaml"));
  const double T_BS[16] = {1, 0, 0, -0.1, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1};  // the body is the IMU
  for (std::size_t i = 0; i < 16; ++i) {
    EXPECT_NEAR(camera["T_BS"]["data"][i].as<double>(), T_BS[i], 1e-12) << i;
    EXPECT_EQ(imu["T_BS"]["data"][i].as<double>(), i % 5 == 0 ? 1 : 0) << i;
  }
  EXPECT_EQ(imu["gyroscope_noise_density"].as<double>(), 0.001);
  EXPECT_EQ(imu["accelerometer_random_walk"].as<double>(), 0.1);
  EXPECT_EQ(imu["rate_hz"].as<double>(), 200);
  // The biases beside a frame are those of the last reading before it, which have walked away from 0.
  const auto rows = [&](const char* name) {
    std::map<std::int64_t, std::vector<double>> table;
    std::istringstream lines(text(name));
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with('#')) continue;
      std::replace(line.begin(), line.end(), ',', ' ');
      std::istringstream words(line);
      std::int64_t stamp = 0;
      words >> stamp;
      std::vector<double>& numbers = table[stamp];
      for (double number = 0; words >> number;) numbers.push_back(number);
    }
    return table;
  };
  const auto truth = rows("mav0/state_groundtruth_estimate0/data.csv"), bias = rows("mav0/imu0/bias.csv");
  ASSERT_GT(truth.size(), 2u);
  for (const auto& [stamp, numbers] : truth) {
    ASSERT_EQ(numbers.size(), 16u);
    const auto after = bias.upper_bound(stamp);
    if (after == bias.begin()) {  // the reading before the first frame is not in the file
      EXPECT_EQ(stamp, truth.begin()->first);
      continue;
    }
    for (std::size_t c = 0; c < 6; ++c) EXPECT_EQ(numbers[10 + c], std::prev(after)->second[c]) << stamp;
  }
  EXPECT_NE(truth.rbegin()->second[10], 0);
  EXPECT_NE(truth.rbegin()->second[15], 0);
}

// A body that is not the camera, as in EuRoC's own sequences: T_RC = T_RB T_BC, by hand. The camera is 1 m along the
// body's x and turned by 90 degrees about its z; the body is turned by 90 degrees about z, too, and at (0, 0, 5).
TEST(EurocLayout, TruthIsOfTheCameraNotOfTheBody) {
  const sim::TemporaryFolder folder;
  fs::create_directories(folder.path() / "mav0/cam0");
  fs::create_directories(folder.path() / "mav0/state_groundtruth_estimate0");
  folder.Write(
      "mav0/cam0/sensor.yaml",
      "sensor_type: camera\nT_BS:\n  cols: 4\n  rows: 4\n  data: [0.0, -1.0, 0.0, 1.0,\n    1.0, 0.0, 0.0, 0.0,\n"
      "    0.0, 0.0, 1.0, 0.0,\n    0.0, 0.0, 0.0, 1.0]\n");
  folder.Write("mav0/state_groundtruth_estimate0/data.csv",
               "#timestamp, p_RS_R_x [m], ...\r\n"
               "1403636580838555648,0,0,5,0.7071067811865476,0,0,0.7071067811865476,1,2,3,0,0,0,0,0,0\r\n");
  const auto truth = ReadSequenceTruth(folder.path());
  ASSERT_TRUE(truth);
  ASSERT_EQ(truth->poses.size(), 1u);
  EXPECT_EQ(truth->poses[0].stamp_ns, 1403636580838555648);
  EXPECT_LT((truth->poses[0].p_WC - Eigen::Vector3d(0, 1, 5)).norm(), 1e-12);
  EXPECT_LT(truth->poses[0].q_WC.angularDistance(Eigen::Quaterniond(0, 0, 0, 1)), 1e-12) << "180 degrees about z";
  EXPECT_FALSE(truth->velocities);
  folder.Write("mav0/state_groundtruth_estimate0/data.csv",
               "2,0,0,5,1,0,0,0\n1,0,0,5,1,0,0,0\n3,0,0,x,1,0,0,0\n4,0,0,5,2,0,0,0\n");
  try {
    ReadSequenceTruth(folder.path());
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("data.csv:2:1: time 1e-9 lies before 0.000000002"));
    EXPECT_THAT(error.what(), testing::HasSubstr("data.csv:3:7: 'x' is not a finite number"));
    EXPECT_THAT(error.what(), testing::HasSubstr("norm is 2"));
  }
}

}  // namespace
}  // namespace vobench
