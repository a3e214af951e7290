// Files written by the simulator and read by the odometry and the judge: stamps, cameras, colours, truth.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "sim/sequence/layout.h"
#include "tests/temporary_folder.h"
#include "tools/base/text.h"
#include "tools/judge/evaluation/text_file.h"
#include "tools/judge/evaluation/trajectory.h"
#include "vo/geometry/camera.h"
#include "vo/geometry/camera_file.h"
#include "vo/sequence/reader.h"

namespace {
namespace fs = std::filesystem;

class FormatContract : public testing::Test {
 protected:
  FormatContract() { fs::create_directory(here_ / "rgb"); }
  void Write(const std::string& name, const std::string& content) const { folder_.Write(name, content); }

  const vobench_test::TemporaryFolder folder_;
  const fs::path here_ = folder_.path();
};

// Stamps that no double represents to the nanosecond.
const std::vector<std::int64_t> kStamps = {33'333'333, 1'305'031'102'175'304'001, 1'305'031'102'175'304'002};

TEST_F(FormatContract, StampsAreExact) {
  std::string list, truth, velocity;
  for (const std::int64_t stamp : kStamps) {
    const std::string text = base::FormatSeconds(stamp);
    list += text + " rgb/" + text + ".png\n";
    const std::vector<std::uint8_t> png = sim::EncodePng({2, 1, 1, {0, 255}});
    Write("rgb/" + text + ".png", std::string(png.begin(), png.end()));
    truth += sim::TruthLine(stamp, {});
    velocity += sim::VelocityLine(stamp, {});
  }
  Write("rgb.txt", list);
  Write("groundtruth.txt", truth);
  Write("velocity.txt", velocity);
  vo::SequenceReader reader(here_);
  const evaluation::Trajectory poses = evaluation::ReadTrajectory(here_ / "groundtruth.txt");
  const evaluation::Velocities velocities = evaluation::ReadVelocities(here_ / "velocity.txt");
  ASSERT_EQ(poses.size(), kStamps.size());
  for (std::size_t k = 0; k < kStamps.size(); ++k) {
    EXPECT_EQ(reader.Next()->stamp_ns, kStamps[k]);
    EXPECT_EQ(poses[k].stamp_ns, kStamps[k]);
    EXPECT_EQ(velocities[k].stamp_ns, kStamps[k]);
  }
}

TEST_F(FormatContract, TruthIsReadAsWritten) {
  sim::Truth truth;
  truth.p_WC = {1.25, -2.5, 3.125};
  truth.q_WC = {0.8, 0.2, -0.4, 0.4};  // w x y z
  truth.v_WC = {0.5, -0.25, 8};
  truth.w_WC_C = {-1, 0.125, 2};
  Write("groundtruth.txt", sim::TruthLine(1'000'000'000, truth));
  Write("velocity.txt", sim::VelocityLine(1'000'000'000, truth));
  const evaluation::StampedPose pose = evaluation::ReadTrajectory(here_ / "groundtruth.txt").front();
  const evaluation::StampedVelocity velocity = evaluation::ReadVelocities(here_ / "velocity.txt").front();
  EXPECT_EQ(pose.p_WC, Eigen::Vector3d(1.25, -2.5, 3.125));
  EXPECT_NEAR((pose.q_WC.coeffs() - Eigen::Vector4d(0.2, -0.4, 0.4, 0.8)).norm(), 0, 1e-15);  // x y z w
  EXPECT_EQ(velocity.v_WC, Eigen::Vector3d(0.5, -0.25, 8));
  EXPECT_EQ(velocity.w_WC_C, Eigen::Vector3d(-1, 0.125, 2));
}

TEST_F(FormatContract, TheCameraIsReadAsWritten) {
  sim::CameraParams written;
  written.width = 320;
  written.height = 200;
  written.fx = 517.306408;
  written.fy = 516.469215;
  written.cx = 318.64304 / 2;
  written.cy = 1.0 / 3;
  written.k1 = 0.0262383;
  written.k2 = -0.00953104;
  written.p1 = -0.005358;
  written.p2 = 0.002628;
  written.k3 = 0.001163314;
  Write("camera.yaml", sim::CameraYaml(written, 0.026));
  const vo::Camera read = vo::ReadCamera(here_ / "camera.yaml");
  EXPECT_EQ(read.readout_s, 0.026);
  Write("global.yaml", sim::CameraYaml(written, 0));
  EXPECT_EQ(vo::ReadCamera(here_ / "global.yaml").readout_s, 0.0) << "stated";
  EXPECT_EQ(read.width, written.width);
  EXPECT_EQ(read.height, written.height);
  EXPECT_EQ(read.fx, written.fx);
  EXPECT_EQ(read.fy, written.fy);
  EXPECT_EQ(read.cx, written.cx);
  EXPECT_EQ(read.cy, written.cy);
  EXPECT_EQ(read.k1, written.k1);
  EXPECT_EQ(read.k2, written.k2);
  EXPECT_EQ(read.p1, written.p1);
  EXPECT_EQ(read.p2, written.p2);
  EXPECT_EQ(read.k3, written.k3);
}

TEST_F(FormatContract, ColoursAndRowsKeepTheirPlace) {
  // Red and green above, blue and white below; red first.
  const std::vector<std::uint8_t> png = sim::EncodePng({2, 2, 3, {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255}});
  Write("rgb/1.png", std::string(png.begin(), png.end()));
  Write("rgb.txt", "1.0 rgb/1.png\n");
  const cv::Mat image = vo::SequenceReader(here_).Next()->image;
  ASSERT_EQ(image.type(), CV_8UC3);
  EXPECT_EQ(image.at<cv::Vec3b>(0, 0), cv::Vec3b(0, 0, 255));  // blue, green, red
  EXPECT_EQ(image.at<cv::Vec3b>(0, 1), cv::Vec3b(0, 255, 0));
  EXPECT_EQ(image.at<cv::Vec3b>(1, 0), cv::Vec3b(255, 0, 0));
  EXPECT_EQ(image.at<cv::Vec3b>(1, 1), cv::Vec3b(255, 255, 255));
}

}  // namespace
