// Sequences served to external programs: rectified images, and the photometric calibration.
#include "tools/bench/run/served_sequence.h"

#include <gmock/gmock.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <set>
#include <sstream>

#include "sim/sensor/develop.h"
#include "sim/simulator.h"
#include "source_dir.h"
#include "tests/unit/bench/campaign/folder.h"
#include "tools/bench/run/campaign_sequence.h"
#include "tools/bench/run/euroc_folder.h"
#include "tools/bench/systems/bridge.h"
#include "tools/bench/systems/experiment.h"
#include "vo/geometry/camera_file.h"

namespace vobench {
namespace {
namespace fs = std::filesystem;

const Overrides kOneFrame = {
    {"time.duration", "0.03 s"},    {"sensor.exposure", "0 s"},   {"sensor.time_samples", "64"},
    {"sensor.shot_noise", "false"}, {"sensor.read_noise", "0 e"}, {"sensor.color", "false"},
    {"camera.width", "330"},        {"camera.height", "250"},     {"camera.fx", "280"},
    {"camera.fy", "280"},           {"camera.cx", "163"},         {"camera.cy", "126"}};
const Overrides kFreiburg1 = {{"camera.distortion",
                               "{k1: 0.262383, k2: -0.953104, p1: -0.005358, p2: 0.002628, "
                               "k3: 1.163314}"}};
const Overrides kBarrel = {{"camera.distortion", "{k1: -0.28, k2: 0.07, p1: 0.0002, p2: 0.00002}"}};
const Overrides kFisheye = {{"camera.distortion", "{model: fisheye, k1: -0.01, k2: 0.02, k3: -0.01, k4: 0.002}"}};

sim::Scenario With(const std::vector<Overrides>& all) {
  Overrides joined = kOneFrame;
  for (const Overrides& some : all) joined.insert(joined.end(), some.begin(), some.end());
  return sim::LoadScenario(VOBENCH_SOURCE_DIR "/scenes/tiny.yaml", joined);
}

cv::Mat FirstFrame(const sim::Scenario& scenario) { return ToOdometry(sim::Simulator(scenario, 2).Render(0)).image; }

class ServedSequenceTest : public testing::Test {
 protected:
  ServedSequence Served(const sim::Scenario& scenario, bool rectified, campaign::SequenceLayout layout) {
    campaign::ExternalSystem system;
    system.rectified = rectified;
    system.layout = layout;
    SeenSequence seen;
    seen.experiment.scenario = scenario;
    MakeIn(cache_, "key", seen, 2);
    return Serve(cache_, "key", scenario, true, system);
  }
  campaign::Folder here_;
  campaign::SequenceCache cache_{here_.path()};
};

double MeanDifference(const cv::Mat& a, const cv::Mat& b) {
  cv::Mat difference;
  cv::absdiff(a, b, difference);
  return cv::mean(difference)[0];
}

// Largest shift between two images in nine parts of them, by least squares on the gradient [px].
double LargestShift(const cv::Mat& a, const cv::Mat& b) {
  cv::Mat as, bs, dx, dy;
  a.convertTo(as, CV_64F), b.convertTo(bs, CV_64F);
  cv::Sobel(bs, dx, CV_64F, 1, 0, 3, 1.0 / 8), cv::Sobel(bs, dy, CV_64F, 0, 1, 3, 1.0 / 8);
  const cv::Mat difference = as - bs;
  double largest = 0;
  for (int i = 0; i < 9; ++i) {
    const cv::Rect part(i % 3 * (a.cols / 3), i / 3 * (a.rows / 3), a.cols / 3, a.rows / 3);
    const cv::Mat x = dx(part), y = dy(part), d = difference(part);
    const cv::Matx22d normal(x.dot(x), x.dot(y), x.dot(y), y.dot(y));
    const cv::Matx21d shift = normal.solve(cv::Matx21d(x.dot(d), y.dot(d)));
    largest = std::max({largest, std::abs(shift(0)), std::abs(shift(1))});
  }
  return largest;
}

cv::Mat Moved(const cv::Mat& image, double dx) {
  const cv::Matx23d by(1, 0, dx, 0, 1, 0);
  cv::Mat moved;
  cv::warpAffine(image, moved, by, image.size(), cv::INTER_CUBIC, cv::BORDER_REPLICATE);
  return moved;
}

// Ours with the images alone is not given the shutter's time of a rendered sequence, nor is another program.
TEST_F(ServedSequenceTest, HasNoTimeOfTheShutter) {
  const ServedSequence served =
      Served(With({{{"sensor.rolling_shutter", "5 ms"}}}), false, campaign::SequenceLayout::tum);
  EXPECT_FALSE(vo::ReadCamera(served.folder / "camera.yaml").readout_s);
}

// Rectified image against the rendering of a pinhole camera, in all parts.
TEST_F(ServedSequenceTest, ARectifiedPictureIsThatOfThePinhole) {
  for (const Overrides& lens : {kFreiburg1, kBarrel, kFisheye}) {
    fs::remove_all(here_.path() / "ke");
    const sim::Scenario distorted = With({lens});
    const ServedSequence served = Served(distorted, true, campaign::SequenceLayout::images);
    EXPECT_EQ(served.camera.width, 320);
    EXPECT_EQ(served.camera.height, 240);
    sim::Scenario straight = distorted;
    straight.camera = vobench::ToSimulator(vo::ReadCamera(served.folder / "camera.yaml"));
    EXPECT_EQ(straight.camera.fx, served.camera.fx) << "as camera.yaml says";
    const cv::Mat expected = FirstFrame(straight);
    const cv::Mat rectified = cv::imread((served.folder / "images/000000.png").string(), cv::IMREAD_UNCHANGED);
    ASSERT_EQ(rectified.size(), expected.size());
    EXPECT_LT(LargestShift(rectified, expected), 0.1);
    EXPECT_GT(LargestShift(Moved(rectified, 0.3), expected), 0.2) << "control";
    // No black border: every pixel lies in the distorted image.
    const sim::Camera camera(distorted.camera);
    for (const int x : {0, 160, 319}) {
      for (const int y : {0, 120, 239}) {
        const sim::CameraParams& c = served.camera;
        const glm::dvec2 pixel = camera.Project({(x - c.cx) / c.fx, (y - c.cy) / c.fy, 1});
        EXPECT_GE(std::min(pixel.x, pixel.y), -1e-6);
        EXPECT_LE(pixel.x, 329 + 1e-6);
        EXPECT_LE(pixel.y, 249 + 1e-6);
      }
    }
  }
}

TEST_F(ServedSequenceTest, OfAPinholeTheMiddleIsCutOut) {
  const sim::Scenario scenario = With({});
  const ServedSequence served = Served(scenario, true, campaign::SequenceLayout::tum);
  EXPECT_EQ(served.camera.cx, 163 - 5);
  EXPECT_EQ(served.camera.cy, 126 - 5);
  const cv::Mat image = cv::imread((served.folder / "rgb/0.000000000.png").string(), cv::IMREAD_UNCHANGED);
  EXPECT_EQ(MeanDifference(image, FirstFrame(scenario)(cv::Rect(5, 5, 320, 240))), 0);
}

TEST_F(ServedSequenceTest, PicturesThatNeedNothingAreServedAsTheyAre) {
  const sim::Scenario scenario = With({{{"camera.width", "320"}, {"camera.height", "240"}}});
  const fs::path folder = Served(scenario, true, campaign::SequenceLayout::tum).folder;
  EXPECT_TRUE(fs::equivalent(folder / "rgb", cache_.PathOf("key") / "rgb"));
  // Neither truth nor scenario is served.
  std::set<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename());
  EXPECT_THAT(names, testing::ElementsAre("camera.yaml", "rgb", "rgb.txt"));
  EXPECT_TRUE(fs::exists(cache_.PathOf("key") / "groundtruth.txt")) << "control: it is there to be given away";
}

// Rig with IMU in EuRoC's layout: each system gets the sensors that it takes.
TEST_F(ServedSequenceTest, ARigIsServedAsEuroc) {
  SeenSequence seen;
  seen.experiment.scenario =
      sim::LoadScenario(VOBENCH_SOURCE_DIR "/scenes/stereo.yaml",
                        {{"time.duration", "0.15 s"},
                         {"truth", "[imu]"},
                         {"imu.position", "[0, 0.02, 0]"},
                         {"imu.orientation", "[0, 0, 0, 1]"},
                         {"imu.gravity", "[0, -9.7, 0]"},
                         {"cameras",
                          "[{name: left, width: 40, height: 30, fx: 40, fy: 40, cx: 19.5, cy: 14.5}, {name: right, "
                          "width: 40, height: 30, fx: 40, fy: 40, cx: 19.5, cy: 14.5, position: [0.1, 0, 0], "
                          "trigger_offset: 5 ms}]"}});
  seen.sensors = {true, true};
  MakeIn(cache_, "key", seen, 2);
  fs::rename(cache_.PathOf("key"),
             cache_.PathOf("key").string() + ".partial");  // as after a kill before the last step
  MakeIn(cache_, "key", seen, 2);
  campaign::ExternalSystem system;
  const auto files = [&](campaign::Sensors sensors) {
    system.layout = sensors.metric() ? campaign::SequenceLayout::euroc : campaign::SequenceLayout::tum;
    system.sensors = sensors;
    const ServedSequence served = Serve(cache_, "key", seen.experiment.scenario, true, system);
    EXPECT_EQ(served.stamps_ns.size(), 3u);
    std::set<std::string> names;
    for (const auto& entry :
         fs::recursive_directory_iterator(served.folder, fs::directory_options::follow_directory_symlink))
      if (entry.is_regular_file())
        names.insert(fs::relative(entry.path().parent_path(), served.folder).string() + "/" +
                     entry.path().filename().string());
    return std::pair(served.folder, names);
  };
  const auto [folder, all] = files({true, true});
  for (const char* file :
       {"mav0/cam0/sensor.yaml", "mav0/cam1/sensor.yaml", "mav0/imu0/data.csv", "mav0/imu0/sensor.yaml"})
    EXPECT_TRUE(fs::exists(folder / file)) << file;
  // Each image is listed, and of its own camera; the stamps of cam1 have its offset.
  for (const int k : {0, 1}) {
    const vo::SequenceReader reader(folder, vo::SequenceReader::Images::needed, k);
    ASSERT_EQ(reader.size(), 3u);
    EXPECT_EQ(reader.entries()[1].stamp_ns, 50000000 + 5000000 * k);
    const fs::path own = cache_.PathOf("key") / (k == 0 ? "left" : "right");
    EXPECT_TRUE(fs::equivalent(reader.entries()[1].image, vo::SequenceReader(own).entries()[1].image));
  }
  const Eigen::Isometry3d T_IC = CameraInImu(folder);
  EXPECT_LT((T_IC.translation() - Eigen::Vector3d(0, -0.02, 0)).norm(), 1e-12);
  EXPECT_THAT(campaign::Folder::TemporaryFolder::Read(folder / "mav0/imu0/sensor.yaml"),
              testing::HasSubstr("\ngravity: 9.7 "));
  EXPECT_TRUE(fs::exists(files({true, false}).first / "mav0/cam1"));
  EXPECT_FALSE(fs::exists(files({true, false}).first / "mav0/imu0"));
  EXPECT_FALSE(fs::exists(files({false, true}).first / "mav0/cam1"));
  EXPECT_TRUE(fs::exists(files({false, true}).first / "mav0/imu0/data.csv"));
  EXPECT_TRUE(fs::exists(files({false, false}).first / "rgb/0.050000000.png"));
  for (const campaign::Sensors sensors :
       {campaign::Sensors{true, true}, {true, false}, {false, true}, {false, false}}) {
    for (const std::string& name : files(sensors).second)
      for (const char* truth : {"truth", "velocity", "bias", "rig.yaml", "manifest"})
        EXPECT_EQ(name.find(truth), std::string::npos) << name;
  }
}

// Keys of the cache: unchanged unless there are more sensors.
TEST_F(ServedSequenceTest, OnlyWhatHasMoreSensorsHasAnotherKey) {
  SeenSequence seen;
  seen.experiment.scenario = With({});
  FindWorld(seen.experiment.scenario, cache_);
  const auto one = SequenceKey(seen, cache_);
  ASSERT_TRUE(one);
  for (const campaign::Sensors sensors : {campaign::Sensors{true, false}, {false, true}, {true, true}}) {
    seen.sensors = sensors;
    EXPECT_NE(SequenceKey(seen, cache_), one);
  }
  seen.sensors = {};
  EXPECT_EQ(SequenceKey(seen, cache_), one);
}

// Photometric calibration: G(code) / V is the linear image without vignetting, up to quantisation: half a step of an
// sRGB code is 1.2 of 255 at white, of a linear one a half.
TEST_F(ServedSequenceTest, ThePhotometricCalibrationUndoesResponseAndVignetting) {
  const Overrides fall_off = {{"sensor.optics.vignetting_2", "-0.4"}, {"sensor.optics.natural_vignetting", "true"}};
  for (const bool rectified : {false, true}) {
    fs::remove_all(here_.path() / "ke");
    const sim::Scenario scenario = With({fall_off, kBarrel});
    const ServedSequence served = Served(scenario, rectified, campaign::SequenceLayout::images);
    EXPECT_EQ(campaign::Folder::TemporaryFolder::Read(served.folder / "times.txt"), "000000 0.000000000 0\n");
    std::istringstream response(campaign::Folder::TemporaryFolder::Read(served.folder / "pcalib.txt"));
    const std::vector<double> G(std::istream_iterator<double>(response), {});
    ASSERT_EQ(G.size(), 256u);
    for (std::size_t i = 1; i < G.size(); ++i) ASSERT_GT(G[i], G[i - 1]);
    const cv::Mat V = cv::imread((served.folder / "vignette.png").string(), cv::IMREAD_UNCHANGED);
    const cv::Mat image = cv::imread((served.folder / "images/000000.png").string(), cv::IMREAD_UNCHANGED);
    ASSERT_EQ(V.type(), CV_16U);
    ASSERT_EQ(V.size(), image.size());
    sim::Scenario plain = With({kBarrel, {{"sensor.response", "linear"}}});
    plain.camera = served.camera;
    const cv::Mat linear = FirstFrame(plain);
    double sum = 0, uncorrected = 0, darkest = 1;
    for (int y = 0; y < image.rows; ++y) {
      for (int x = 0; x < image.cols; ++x) {
        const double factor = V.at<std::uint16_t>(y, x) / 65535.0, light = linear.at<std::uint8_t>(y, x);
        if (linear.at<std::uint8_t>(y, x) > 200) continue;  // near saturation
        darkest = std::min(darkest, factor);
        const double error = std::abs(G[image.at<std::uint8_t>(y, x)] / factor - light);
        if (!rectified) {
          ASSERT_LE(error, 0.5 + 1.2 / factor + 1e-2) << x << " " << y;
        }
        sum += error;
        uncorrected += std::abs(G[image.at<std::uint8_t>(y, x)] - light);
      }
    }
    EXPECT_LT(darkest, 0.6);
    EXPECT_LT(5 * sum, uncorrected) << "control: without the vignette";
  }
}

TEST_F(ServedSequenceTest, ACurveThatIsNotTheResponseAloneIsNotWritten) {
  const auto served = Served(With({{{"sensor.processing.contrast", "1.2"}}}), false, campaign::SequenceLayout::images);
  EXPECT_FALSE(fs::exists(served.folder / "pcalib.txt"));
  EXPECT_FALSE(fs::exists(served.folder / "vignette.png"));
}

TEST_F(ServedSequenceTest, ExposuresAreThoseThatTheCameraChose) {
  const sim::Scenario scenario =
      With({{{"time.duration", "0.2 s"},
             {"sensor.exposure", "1 ms"},
             {"sensor.gain", "1"},
             {"sensor.auto_exposure", "{on: true, target: 0.6, speed: 1, longest: 10 ms}"}}});
  const ServedSequence served = Served(scenario, false, campaign::SequenceLayout::images);
  std::istringstream times(campaign::Folder::TemporaryFolder::Read(served.folder / "times.txt"));
  std::istringstream chosen(campaign::Folder::TemporaryFolder::Read(cache_.PathOf("key") / "exposure.txt"));
  std::string line, number, stamp;
  double time = 0, exposure_ms = 0, exposure_s = 0, gain = 0, least = 1e9, most = 0;
  int frames = 0;
  while (std::getline(chosen, line)) {
    if (line.starts_with('#')) continue;
    std::istringstream(line) >> time >> exposure_s >> gain;
    ASSERT_TRUE(times >> number >> stamp >> exposure_ms);
    EXPECT_NEAR(exposure_ms, 1e3 * exposure_s * gain, 1e-6 * exposure_ms);
    least = std::min(least, exposure_ms), most = std::max(most, exposure_ms);
    ++frames;
  }
  EXPECT_EQ(frames, 6);
  EXPECT_GT(most, 1.1 * least);
}

}  // namespace
}  // namespace vobench
