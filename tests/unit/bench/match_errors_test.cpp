// Errors of matches against known truth: a plane before a camera that rotates and translates, with a rolling shutter
// and a distorted lens.
#include "tools/bench/tracking/match_errors.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <fstream>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/temporary_folder.h"
#include "tools/base/text.h"

namespace vobench {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kFrames = 75;
const Vector3d kNormal = Vector3d(0.3, -0.2, 1).normalized();  // of the plane n'X = 2.5
constexpr double kOffset = 2.5;

vo::Camera Lens() {
  vo::Camera camera;
  camera.width = 320;
  camera.height = 240;
  camera.fx = camera.fy = 260;
  camera.cx = 159.5;
  camera.cy = 119.5;
  camera.k1 = 0.1;
  camera.k2 = -0.1;
  camera.readout_s = 0.026;
  return camera;
}

std::int64_t StampOf(int frame) { return std::int64_t{frame} * 100'000'000 / 3; }

vo::Pose PoseAt(double t) {
  const Eigen::AngleAxisd yaw(0.3 * std::sin(3 * t), Vector3d::UnitY()),
      pitch(0.2 * std::sin(4 * t), Vector3d::UnitX());
  return {Vector3d(0.3 * std::sin(2 * t), 0.1 * std::sin(3 * t), 0.2 * std::sin(t)), Eigen::Quaterniond(yaw * pitch)};
}

// Velocities by finite differences, independent of the code under test.
Truth TruthOf(double late_s = 0) {
  Truth truth;
  truth.velocities.emplace();
  for (int frame = 0; frame < kFrames; ++frame) {
    const double t = 1e-9 * static_cast<double>(StampOf(frame)) - late_s, h = 1e-5;
    const vo::Pose now = PoseAt(t), before = PoseAt(t - h), after = PoseAt(t + h);
    const Eigen::AngleAxisd turn(before.q_WC.conjugate() * after.q_WC);
    truth.poses.push_back({StampOf(frame), now.p_WC, now.q_WC});
    truth.velocities->push_back(
        {StampOf(frame), (after.p_WC - before.p_WC) / (2 * h), turn.angle() * turn.axis() / (2 * h)});
  }
  return truth;
}

double RowTime(const vo::Camera& camera, std::int64_t stamp_ns, double row) {
  return 1e-9 * static_cast<double>(stamp_ns) + camera.readout_s.value_or(0) * (row / (camera.height - 1) - 0.5);
}

Vector3d OnPlane(const vo::Pose& pose, const Vector2d& xy) {
  const Vector3d ray = pose.q_WC * xy.homogeneous();
  return pose.p_WC + ray * (kOffset - kNormal.dot(pose.p_WC)) / kNormal.dot(ray);
}

Vector2d Seen(const vo::Camera& camera, const Vector3d& X_W, std::int64_t stamp_ns) {
  Vector2d pixel(0, 120);
  for (int round = 0; round < 30; ++round) {
    const vo::Pose pose = PoseAt(RowTime(camera, stamp_ns, pixel.y()));
    pixel = camera.Project(pose.q_WC.conjugate() * (X_W - pose.p_WC));
  }
  return pixel;
}

// Sequence with nothing but the depth of its first frame.
void WriteDepth(const vobench_test::TemporaryFolder& folder, const vo::Camera& camera) {
  cv::Mat depth(camera.height, camera.width, CV_16UC1);
  const vo::Pose pose = PoseAt(0);
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const Vector3d X_C = pose.q_WC.conjugate() * (OnPlane(pose, camera.Undistort(Vector2d(x, y))) - pose.p_WC);
      depth.at<std::uint16_t>(y, x) = static_cast<std::uint16_t>(std::lround(5000 * X_C.z()));
    }
  }
  cv::imwrite((folder / "0.png").string(), depth);
  folder.Write("depth.txt", "0.000000000 0.png\n");
}

using Row = std::map<std::string, std::string>;

std::vector<Row> ReadCsv(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::vector<std::string> head;
  std::vector<Row> rows;
  for (std::string line; std::getline(stream, line);) {
    std::vector<std::string> words;
    std::istringstream fields(line);
    for (std::string word; std::getline(fields, word, ',');) words.push_back(word);
    words.resize(std::max(words.size(), head.size()));
    if (head.empty()) {
      head = words;
      continue;
    }
    Row& row = rows.emplace_back();
    for (std::size_t i = 0; i < head.size(); ++i) row[head[i]] = words[i];
  }
  return rows;
}

// Twelve landmarks from the first frame on, matched in each with an error of `off`, predicted 3 px beside the match.
std::vector<Row> Measured(const vo::Camera& camera, const Truth& truth, const Vector2d& off, bool with_depth = true) {
  const vobench_test::TemporaryFolder folder;
  const vo::Camera real = Lens();
  if (with_depth) WriteDepth(folder, real);
  MatchErrors errors(folder.path(), camera, truth);
  std::vector<vo::FeatureView> features;
  std::vector<Vector3d> points;
  for (int id = 0; id < 12; ++id) {
    const Vector2d pixel(60 + 50 * (id % 4), 50.25 + 60 * (id / 4));
    points.push_back(OnPlane(PoseAt(RowTime(real, 0, pixel.y())), real.Undistort(pixel)));
    features.push_back({.id = id, .predicted = pixel, .pixel = pixel, .status = vo::FeatureView::Status::fresh});
  }
  errors.Add(0, features);
  for (int frame = 1; frame < kFrames; ++frame) {
    for (vo::FeatureView& feature : features) {
      const Vector2d pixel = Seen(real, points[static_cast<std::size_t>(feature.id)], StampOf(frame));
      feature.status = vo::FeatureView::Status::matched;
      feature.pixel = pixel + off;
      feature.predicted = feature.pixel + Vector2d(3, 0);
      feature.S = 9 * Eigen::Matrix2d::Identity();
    }
    const bool away = frame >= 20 && frame < 60;
    errors.Add(StampOf(frame), away ? std::vector<vo::FeatureView>{} : features);
  }
  errors.Write(folder.path());
  return ReadCsv(folder / "matches.csv");
}

double Largest(const std::vector<Row>& rows, const std::string& column) {
  double largest = 0;
  for (const Row& row : rows)
    if (!row.at(column).empty()) largest = std::max(largest, std::stod(row.at(column)));
  return largest;
}

TEST(MatchErrors, AreThoseOfTheMatches) {
  const std::vector<Row> exact = Measured(Lens(), TruthOf(), Vector2d::Zero());
  ASSERT_EQ(exact.size(), kFrames);
  EXPECT_LT(Largest(exact, "match_95"), 0.02);  // the depth's step of 0.2 mm, and the poses between the frames
  EXPECT_LT(Largest(exact, "epipolar_95"), 0.02);
  EXPECT_GT(Largest(exact, "match_95"), 0);
  const std::vector<Row> off = Measured(Lens(), TruthOf(), Vector2d(1.2, -1.6));
  for (const int frame : {1, 10, 70}) {
    const Row& row = off[static_cast<std::size_t>(frame)];
    EXPECT_NEAR(std::stod(row.at("match_median")), 2, 0.02);
    EXPECT_LT(std::stod(row.at("epipolar_median")), 2.02);
    EXPECT_NEAR(std::stod(row.at("prediction_median")), 3, 1e-3);
    EXPECT_NEAR(std::stod(row.at("true_prediction_median")), std::hypot(4.2, -1.6), 0.02);
    EXPECT_NEAR(std::stod(row.at("innovation_median")), 0.5, 1e-3);
  }
}

TEST(MatchErrors, WithoutDepthOnlyAcrossTheEpipolarLine) {
  const std::vector<Row> rows = Measured(Lens(), TruthOf(), Vector2d::Zero(), false);
  EXPECT_LT(Largest(rows, "epipolar_95"), 0.02);
  EXPECT_EQ(rows[5].at("match_median"), "");
  EXPECT_EQ(rows[5].at("true_prediction_median"), "");
}

TEST(MatchErrors, AWrongTruthIsSeen) {
  vo::Camera global = Lens();
  global.readout_s = 0;
  EXPECT_GT(Largest(Measured(global, TruthOf(), Vector2d::Zero()), "match_95"), 1);
  EXPECT_GT(Largest(Measured(Lens(), TruthOf(0.01), Vector2d::Zero()), "match_95"), 1);
  EXPECT_GT(Largest(Measured(Lens(), TruthOf(0.01), Vector2d::Zero()), "epipolar_95"), 1);
}

TEST(MatchErrors, CountsWhatIsSeenAgainAfterASecond) {
  const std::vector<Row> rows = Measured(Lens(), TruthOf(), Vector2d::Zero());
  EXPECT_EQ(rows[0].at("new"), "12");
  EXPECT_EQ(rows[19].at("reobserved"), "0");
  EXPECT_EQ(rows[30].at("searched"), "0");
  EXPECT_EQ(rows[60].at("reobserved"), "12");
  EXPECT_EQ(rows[61].at("reobserved"), "0");
}

}  // namespace
}  // namespace vobench
