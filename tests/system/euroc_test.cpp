// EuRoC layout, read without the project's readers by the dataset's description (Burri et al. 2016, "The EuRoC micro
// aerial vehicle datasets", section III): dead reckoning, extrinsics, and configuration files of other programs.
#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "tests/system/doc_page.h"
#include "tests/system/program.h"
#include "vo/geometry/camera_file.h"

namespace vobench::system_test {
namespace {
namespace fs = std::filesystem;
using Eigen::Isometry3d, Eigen::Quaterniond, Eigen::Vector3d;

// Line of a data.csv: nanoseconds, then numbers.
struct Row {
  std::int64_t t_ns;
  std::vector<double> values;
  std::string text;  // the last field
};
std::vector<Row> ReadCsv(const fs::path& file) {
  std::vector<Row> rows;
  std::istringstream lines(ReadFile(file));
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    std::string word;
    std::getline(words, word, ',');
    Row& row = rows.emplace_back();
    row.t_ns = std::stoll(word);
    while (std::getline(words, word, ',')) {
      row.text = word;
      row.values.push_back(word.ends_with(".png") ? 0 : std::stod(word));
    }
  }
  return rows;
}

// Numbers in brackets after a key of a sensor.yaml.
std::vector<double> Numbers(const std::string& yaml, const std::string& key) {
  const std::size_t open = yaml.find('[', yaml.find(key + ":"));
  std::string list = yaml.substr(open + 1, yaml.find(']', open) - open - 1);
  std::ranges::replace(list, ',', ' ');
  std::istringstream words(list);
  std::vector<double> numbers;
  for (double number; words >> number;) numbers.push_back(number);
  return numbers;
}
Isometry3d Extrinsic(const fs::path& sensor) {
  const std::vector<double> data = Numbers(ReadFile(sensor / "sensor.yaml"), "data");
  Isometry3d T = Isometry3d::Identity();
  for (int i = 0; i < 12; ++i) T.matrix()(i / 4, i % 4) = data.at(static_cast<std::size_t>(i));
  return T;
}

struct State {
  Vector3d p, v;
  Quaterniond q;
};
State StateOf(const Row& row) {
  const std::vector<double>& x = row.values;
  return {{x[0], x[1], x[2]}, {x[7], x[8], x[9]}, Quaterniond(x[3], x[4], x[5], x[6]).normalized()};
}
// q' = q w / 2, v' = R f + g, p' = v by a Runge-Kutta method of the given order; order 4 has steps of two readings.
State Integrate(State x, const std::vector<Row>& imu, int order) {
  const Vector3d g(0, 0, -9.81);
  const auto w = [&](std::size_t k) { return Vector3d(imu[k].values[0], imu[k].values[1], imu[k].values[2]); };
  const auto f = [&](std::size_t k) { return Vector3d(imu[k].values[3], imu[k].values[4], imu[k].values[5]); };
  const std::size_t stride = order == 4 ? 2 : 1;
  struct Slope {
    Vector3d p, v;
    Eigen::Vector4d q;
  };
  const auto slope = [&](const State& s, const Eigen::Vector4d& q, std::size_t k) {
    const Quaterniond turn(q), rate(0, w(k).x(), w(k).y(), w(k).z());
    return Slope{s.v, turn.normalized() * f(k) + g, 0.5 * (turn * rate).coeffs()};
  };
  for (std::size_t k = 0; k + stride < imu.size(); k += stride) {
    const double h = static_cast<double>(imu[k + stride].t_ns - imu[k].t_ns) * 1e-9;
    const auto moved = [&](const Slope& s, double dt) {
      return std::pair(State{x.p + dt * s.p, x.v + dt * s.v, x.q}, Eigen::Vector4d(x.q.coeffs() + dt * s.q));
    };
    const Slope a = slope(x, x.q.coeffs(), k);
    Slope sum = a;
    if (order == 2) {
      const auto [s, q] = moved(a, h);
      const Slope b = slope(s, q, k + 1);
      sum = {(a.p + b.p) / 2, (a.v + b.v) / 2, (a.q + b.q) / 2};
    } else if (order == 4) {
      const auto [s1, q1] = moved(a, h / 2);
      const Slope b = slope(s1, q1, k + 1);
      const auto [s2, q2] = moved(b, h / 2);
      const Slope c = slope(s2, q2, k + 1);
      const auto [s3, q3] = moved(c, h);
      const Slope d = slope(s3, q3, k + 2);
      sum = {(a.p + 2 * b.p + 2 * c.p + d.p) / 6, (a.v + 2 * b.v + 2 * c.v + d.v) / 6,
             (a.q + 2 * b.q + 2 * c.q + d.q) / 6};
    }
    x.p += h * sum.p;
    x.v += h * sum.v;
    x.q.coeffs() += h * sum.q;
    x.q.normalize();
  }
  return x;
}

class EurocTest : public testing::Test {
 protected:
  // Two cameras and an IMU on a swinging body, at 100 Hz for 0.34 s.
  void Render(const std::string& layout, const std::string& lens = "") {
    const std::string camera = "width: 32, height: 24, fx: 26.25, fy: 26.5, cx: 15.5, cy: 11.5" + lens;
    const std::string mesh = (TinyScenario().parent_path() / "room/room.obj").string();
    WriteFile(here_ / "rig.yaml", "world:\n  meshes: [{file: " + mesh + R"(}]
  lights: [{type: ambient, radiance: [1, 1, 1]}]
cameras:
  - {)" + camera + R"(, position: [-0.06, 0.01, 0.02], orientation: [0, 0.1, 0, 0.99498743710662]}
  - {)" + camera + R"(, position: [0.06, 0, 0.02]}
sensor: {exposure: 1 ms, time_samples: 1}
time: {rate: 100 Hz, duration: 0.34 s}
trajectory: {type: half_sphere, start: {position: [2, 1.4, 2.5], look_at: [2.3, 1.1, 0]}, center: [2.3, 1.1, 1],
             sweep: 60 deg, period: 2 s, rise: 20 deg, rise_period: 3 s}
truth: [depth, imu]
imu: {rate: 1 kHz, position: [0.03, -0.02, 0.05], orientation: [0.5, -0.5, 0.1, 0.7]}
)");
    const Outcome outcome = RunVobench({"render", "rig.yaml", "-o", layout, "--format", layout}, here_.path());
    ASSERT_EQ(outcome.status, 0) << outcome.err;
  }
  TemporaryFolder here_;
};

TEST_F(EurocTest, DeadReckoningFallsWithTheOrder) {
  Render("euroc");
  const fs::path mav = here_ / "euroc/mav0";
  const std::vector<Row> imu = ReadCsv(mav / "imu0/data.csv"),
                         truth = ReadCsv(mav / "state_groundtruth_estimate0/data.csv");
  ASSERT_EQ(truth.size(), 34u);
  ASSERT_EQ(imu.size(), 331u);
  EXPECT_EQ(imu.back().t_ns, truth.back().t_ns);
  EXPECT_TRUE(Extrinsic(mav / "imu0").isApprox(Isometry3d::Identity())) << "the body is the IMU";
  double error[5] = {};
  for (const int order : {1, 2, 4}) {
    error[order] = (Integrate(StateOf(truth.front()), imu, order).p - StateOf(truth.back()).p).norm();
    RecordProperty("order_" + std::to_string(order), std::to_string(error[order]));
    std::printf("order %d: %.3g m over 0.33 s\n", order, error[order]);
  }
  EXPECT_LT(error[2], 1e-5);
  EXPECT_LT(error[4], 1e-9) << "1e-6 m is asked for";
  EXPECT_LT(error[2], 1e-2 * error[1]);
  EXPECT_LT(error[4], 1e-2 * error[2]);
  EXPECT_GT(error[1], 1e-6) << "the test can fail";
}

// Poses of both cameras from body pose and extrinsics, against those of the TUM layout, whose y is up.
TEST_F(EurocTest, ExtrinsicsAndWorld) {
  Render("euroc");
  Render("tum");
  Eigen::Matrix3d up;
  up << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  const std::vector<Row> truth = ReadCsv(here_ / "euroc/mav0/state_groundtruth_estimate0/data.csv");
  for (const std::string camera : {"cam0", "cam1"}) {
    const Isometry3d T_BS = Extrinsic(here_ / "euroc/mav0" / camera);
    const std::vector<Row> frames = ReadCsv(here_ / "euroc/mav0" / camera / "data.csv");
    ASSERT_EQ(frames.size(), 34u);
    for (const Row& frame : frames) EXPECT_TRUE(fs::exists(here_ / "euroc/mav0" / camera / "data" / frame.text));
    std::istringstream lines(ReadFile(here_ / "tum" / camera / "groundtruth.txt"));
    std::string line;
    std::getline(lines, line);
    for (const Row& row : truth) {
      double t, x[7];
      lines >> t;
      for (double& number : x) lines >> number;
      const State body = StateOf(row);
      const Isometry3d T_RS = Eigen::Translation3d(body.p) * body.q * T_BS;
      EXPECT_LT((T_RS.translation() - up * Vector3d(x[0], x[1], x[2])).norm(), 1e-10);
      EXPECT_LT((T_RS.linear() - up * Quaterniond(x[6], x[3], x[4], x[5]).toRotationMatrix()).norm(), 1e-10);
    }
    const std::vector<double> lens = Numbers(ReadFile(here_ / "euroc/mav0" / camera / "sensor.yaml"), "intrinsics");
    EXPECT_EQ(lens, (std::vector<double>{26.25, 26.5, 15.5, 11.5}));
  }
  EXPECT_THAT(RunVobench({"check", "rig.yaml"}, here_.path()).out, testing::HasSubstr("camera cam1: 32 x 24"));
  // Without an IMU the body is the rig, in the world of the scenario.
  const Outcome outcome =
      RunVobench({"render", "rig.yaml", "-o", "plain", "--format", "euroc", "--truth", "depth"}, here_.path());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NEAR(Extrinsic(here_ / "plain/mav0/cam1").translation().x(), 0.06, 1e-12);
}

Isometry3d OfMatrix(const cv::FileNode& node) {
  cv::Mat matrix;
  node >> matrix;
  matrix.convertTo(matrix, CV_64F);
  Isometry3d T = Isometry3d::Identity();
  for (int i = 0; i < 12; ++i) T.matrix()(i / 4, i % 4) = matrix.at<double>(i / 4, i % 4);
  return T;
}
// A list of four lists.
Isometry3d OfRows(const cv::FileNode& node) {
  Isometry3d T = Isometry3d::Identity();
  for (int i = 0; i < 12; ++i) T.matrix()(i / 4, i % 4) = node[i / 4][i % 4].real();
  return T;
}

// Configuration files, parsed as by their programs (OpenCV's storage, JSON), and lenses by the odometry's reader.
class ConfigsTest : public EurocTest, public testing::WithParamInterface<const char*> {};
INSTANTIATE_TEST_SUITE_P(
    Lenses, ConfigsTest,
    testing::Values("", ", distortion: {k1: -0.1, k2: 0.02, p1: 0.001, p2: -0.002}",
                    ", distortion: {model: fisheye, k1: 0.01, k2: -0.002, k3: 0.001, k4: 0.0001}"));

TEST_P(ConfigsTest, AreParsedBack) {
  Render("euroc", GetParam());
  const fs::path script = ProjectRoot() / "tools/python/examples/vio_configs.py";
  ASSERT_EQ(std::system(("cd " + Quoted(here_.path().string()) + " && /usr/bin/python3 " + Quoted(script.string()) +
                         " euroc 2> err.txt")
                            .c_str()),
            0)
      << ReadFile(here_ / "err.txt");
  const fs::path configs = here_ / "euroc/configs", mav = here_ / "euroc/mav0";
  const Isometry3d T_BS[2] = {Extrinsic(mav / "cam0"), Extrinsic(mav / "cam1")};
  const auto expect = [](const Isometry3d& T, const Isometry3d& expected, double tolerance, const char* what) {
    EXPECT_LT((T.matrix() - expected.matrix()).norm(), tolerance) << what;
  };
  const vo::Camera lens = vo::ReadCamera(mav / "cam0/sensor.yaml");
  for (const char* file : {"kalibr/camchain-imucam.yaml", "openvins/kalibr_imucam_chain.yaml", "vins_fusion/cam0.yaml",
                           "vins_fusion/cam1.yaml", "orb_slam3/settings.yaml", "basalt/calibration.json"}) {
    const vo::Camera read = vo::ReadCamera(configs / file);
    EXPECT_EQ(read.width, 32) << file;
    EXPECT_EQ(read.height, 24) << file;
    EXPECT_EQ(read.lens, lens.lens) << file;
    for (const double vo::Camera::*number :
         {&vo::Camera::fx, &vo::Camera::fy, &vo::Camera::cx, &vo::Camera::cy, &vo::Camera::k1, &vo::Camera::k2,
          &vo::Camera::p1, &vo::Camera::p2, &vo::Camera::k3, &vo::Camera::k4})
      EXPECT_NEAR(read.*number, lens.*number, 1e-12) << file;
  }
  const auto open = [&](const char* file) { return cv::FileStorage((configs / file).string(), cv::FileStorage::READ); };
  const cv::FileStorage chain = open("openvins/kalibr_imucam_chain.yaml"), imu = open("openvins/kalibr_imu_chain.yaml"),
                        openvins = open("openvins/estimator_config.yaml"), vins = open("vins_fusion/config.yaml"),
                        orb = open("orb_slam3/settings.yaml");
  for (int k = 0; k < 2; ++k) {
    const cv::FileNode camera = chain["cam" + std::to_string(k)];
    expect(OfRows(camera["T_cam_imu"]), T_BS[k].inverse(), 1e-10, "Kalibr");
    EXPECT_EQ(camera["rostopic"].string(), "/cam" + std::to_string(k) + "/image_raw");
    expect(OfMatrix(vins["body_T_cam" + std::to_string(k)]), T_BS[k], 1e-10, "VINS-Fusion");
  }
  expect(OfRows(chain["cam1"]["T_cn_cnm1"]), T_BS[1].inverse() * T_BS[0], 1e-10, "Kalibr's chain");
  expect(OfMatrix(orb["Stereo.T_c1_c2"]), T_BS[0].inverse() * T_BS[1], 1e-6, "ORB-SLAM3, floats");
  expect(OfMatrix(orb["IMU.T_b_c1"]), T_BS[0], 1e-6, "ORB-SLAM3, floats");
  // ORB-SLAM3 exits where a real number is written as an integer.
  for (const char* real : {"Camera1.fx", "Camera2.fy", "Camera1.k1", "IMU.NoiseGyro", "IMU.AccWalk", "IMU.Frequency",
                           "Stereo.ThDepth", "ORBextractor.scaleFactor", "Viewer.PointSize"})
    EXPECT_TRUE(orb[real].isReal()) << real;
  for (const char* whole : {"Camera.width", "Camera.height", "Camera.fps", "Camera.RGB", "ORBextractor.nFeatures"})
    EXPECT_TRUE(orb[whole].isInt()) << whole;
  EXPECT_EQ(openvins["max_cameras"].real(), 2);
  EXPECT_EQ(openvins["use_stereo"].string(), "true");
  EXPECT_EQ(openvins["gravity_mag"].real(), 9.81);
  EXPECT_EQ(openvins["relative_config_imucam"].string(), "kalibr_imucam_chain.yaml");
  EXPECT_EQ(imu["imu0"]["update_rate"].real(), 1000);
  EXPECT_EQ(imu["imu0"]["gyroscope_noise_density"].real(), 1.6968e-4) << "no filter takes 0";
  EXPECT_EQ(vins["g_norm"].real(), 9.81);
  EXPECT_EQ(vins["num_of_cam"].real(), 2);
  std::istringstream times(ReadFile(configs / "orb_slam3/times.txt"));
  for (const Row& frame : ReadCsv(mav / "cam0/data.csv")) {
    std::int64_t t_ns = -1;
    EXPECT_TRUE(times >> t_ns && t_ns == frame.t_ns);
  }
  const auto basalt = nlohmann::json::parse(ReadFile(configs / "basalt/calibration.json")).at("value0");
  for (std::size_t k = 0; k < 2; ++k) {
    const auto& T = basalt.at("T_imu_cam").at(k);
    const auto number = [&](const char* name) { return T.at(name).get<double>(); };
    Isometry3d read = Eigen::Translation3d(number("px"), number("py"), number("pz")) *
                      Quaterniond(number("qw"), number("qx"), number("qy"), number("qz"));
    expect(read, T_BS[k], 1e-10, "Basalt");
    EXPECT_EQ(basalt.at("resolution").at(k), nlohmann::json({32, 24}));
  }
  EXPECT_EQ(basalt.at("calib_gyro_bias").size(), 12u);
  EXPECT_EQ(basalt.at("calib_accel_bias").size(), 9u);
}

}  // namespace
}  // namespace vobench::system_test
