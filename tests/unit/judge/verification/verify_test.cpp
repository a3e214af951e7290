// Verification of a simulated sequence: untouched it passes; each kind of damage is detected and named.
#include "tools/judge/verification/verify.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <opencv2/core.hpp>

#include "sim/sequence/encode.h"
#include "sim/sequence/writer.h"
#include "sim/simulator.h"
#include "source_dir.h"
#include "tests/unit/sim/temporary_folder.h"
#include "tools/judge/verification/files.h"

namespace verification {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* kAll =
    "[depth, depth_exr, distance, normals, flow, flow_backward, occlusion, surface_id, landmarks, acceleration, imu]";

void Render(const fs::path& folder, std::vector<std::pair<std::string, std::string>> settings, std::int64_t frames,
            const std::string& scenario = "tiny.yaml") {
  const fs::path file = fs::path(VOBENCH_SOURCE_DIR) / "scenes" / scenario;  // `scenario` itself where it is absolute
  const sim::Simulator simulator(sim::LoadScenario(file, settings), 2);
  const sim::SequenceContent content{sim::Layout::tum, 0, frames, "test"};
  sim::SequenceWriter writer(simulator, folder, content, 2, sim::SequenceWriter::Start::fresh);
  while (writer.Wait() > 0) {
  }
  writer.Finish();
}

std::string Read(const fs::path& file) { return sim::ReadWhole(file); }
void Write(const fs::path& file, const std::string& text) { std::ofstream(file, std::ios::binary) << text; }
template <class Bytes>
void WriteBytes(const fs::path& file, const Bytes& bytes) {
  Write(file, {bytes.begin(), bytes.end()});
}

std::vector<std::string> Lines(const fs::path& file) {
  std::vector<std::string> lines;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}
void WriteLines(const fs::path& file, const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  Write(file, text);
}

std::string Stamp(int k) {
  return std::vector<std::string>{
      "0.000000000", "0.033333333", "0.066666667", "0.100000000",
      "0.133333333", "0.166666667", "0.200000000", "0.233333333"}[static_cast<std::size_t>(k)];
}

// Two sequences, rendered once: `full` with all streams, `plain` of a scenario without `truth`.
class VerifyTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    rendered_ = new sim::TemporaryFolder;
    Render(rendered_->path() / "full", {{"truth", kAll}, {"landmarks.count", "200"}}, 8);
    Render(rendered_->path() / "plain", {}, 8);
  }
  static void TearDownTestSuite() { delete rendered_; }

  // Copy to be damaged.
  fs::path Copy(const std::string& which = "full") {
    fs::copy(rendered_->path() / which, here_.path() / which, fs::copy_options::recursive);
    return here_.path() / which;
  }
  static void Swap(const fs::path& folder, const std::string& stream, const std::string& extension, int a, int b) {
    const fs::path one = folder / stream / (Stamp(a) + extension), two = folder / stream / (Stamp(b) + extension);
    const std::string bytes = Read(one);
    Write(one, Read(two));
    Write(two, bytes);
  }
  // Adds `change` to a number of a table's line (0: the header).
  static void Alter(const fs::path& file, std::size_t line, std::size_t word, double change, char separator = ' ') {
    std::vector<std::string> lines = Lines(file);
    std::stringstream in(lines.at(line)), out;
    std::string text;
    for (std::size_t i = 0; std::getline(in, text, separator); ++i) {
      if (i > 0) out << separator;
      if (i == word) {
        char number[64];
        std::snprintf(number, sizeof number, "%.12f", std::stod(text) + change);
        text = number;
      }
      out << text;
    }
    lines[line] = out.str();
    WriteLines(file, lines);
  }
  // The failures of the checks that failed, as "check: where".
  static std::vector<std::string> Failures(const fs::path& folder) {
    std::vector<std::string> failures;
    for (const Check& check : Verify(folder)) {
      for (const std::string& where : check.failures()) {
        failures.push_back(check.name() + ": " + where + " (" + std::to_string(check.value()) + " > " +
                           std::to_string(check.bound()) + ")");
      }
    }
    return failures;
  }

  static sim::TemporaryFolder* rendered_;
  sim::TemporaryFolder here_;
};
sim::TemporaryFolder* VerifyTest::rendered_ = nullptr;

TEST_F(VerifyTest, AnUntouchedSequencePassesEveryCheck) {
  for (const Check& check : Verify(rendered_->path() / "full")) {
    EXPECT_GT(check.count(), 0u) << check.name();
    EXPECT_THAT(check.failures(), IsEmpty()) << check.name() << ": " << check.value() << " > " << check.bound();
  }
  EXPECT_THAT(Failures(rendered_->path() / "plain"), IsEmpty());
}

// Another motion, a distorted lens, a noisy IMU away from the camera, a range of frames from the middle.
TEST_F(VerifyTest, OtherSequencesPass) {
  std::vector<std::pair<std::string, std::string>> settings = {
      {"truth", kAll},
      {"camera.distortion", "{k1: 0.1, k2: -0.05, p1: 0.002, p2: -0.001}"},
      {"imu.position", "[0.1, 0.02, -0.03]"},
      {"imu.orientation", "[0.5, 0.5, 0.5, 0.5]"},
      {"imu.gyroscope_noise", "2e-3"},
      {"imu.accelerometer_noise", "2e-2"},
      {"imu.gyroscope_walk", "1e-4"},
      {"imu.accelerometer_walk", "1e-3"}};
  Render(here_.path() / "lens", settings, 6);
  EXPECT_THAT(Failures(here_.path() / "lens"), IsEmpty());
  settings = {{"truth", kAll},
              {"trajectory",
               "{type: sampled, start: {position: [2.0, 1.41, 2.55], look_at: [2.35, 1.1, 0.0]}, position_noise: 0.5, "
               "orientation_noise: 0.5}"},
              {"imu.reading", "mean"}};
  Render(here_.path() / "sampled", settings, 6);
  EXPECT_THAT(Failures(here_.path() / "sampled"), IsEmpty());
}

// Coarse pixels: the distortion is not linear between them.
TEST_F(VerifyTest, SmallPicturesThroughALensPass) {
  const std::vector<std::pair<std::string, std::string>> camera[2] = {
      {{"camera", "{width: 80, height: 60, fx: 45, fy: 45, cx: 39.5, cy: 29.5, distortion: {k1: -0.28, k2: 0.07}}"}},
      {{"camera", "{width: 48, height: 36, fx: 24, fy: 24, cx: 23.5, cy: 17.5, distortion: {k1: -0.2, k2: 0.03}}"}}};
  for (int i = 0; i < 2; ++i) {
    auto settings = camera[i];
    settings.emplace_back("truth", "[depth, depth_exr, distance, normals, flow, flow_backward, surface_id]");
    const fs::path folder = here_.path() / ("small" + std::to_string(i));
    Render(folder, settings, 6);
    EXPECT_THAT(Failures(folder), IsEmpty());
  }
}

TEST_F(VerifyTest, StampsShiftedInOneList) {
  for (const char* list : {"depth.txt", "groundtruth.txt", "velocity.txt", "flow.txt", "rgb.txt"}) {
    const fs::path folder = Copy();
    std::vector<std::string> lines = Lines(folder / list);
    for (std::size_t i = 1; i < lines.size(); ++i) {
      const std::string next = i + 1 < lines.size() ? lines[i + 1].substr(0, 11) : "0.266666667";
      lines[i] = next + lines[i].substr(11);
    }
    WriteLines(folder / list, lines);
    EXPECT_THAT(Failures(folder), Contains(testing::AllOf(HasSubstr("stamps: "), HasSubstr(list)))) << list;
    fs::remove_all(folder);
  }
}

TEST_F(VerifyTest, TwoPicturesSwapped) {
  for (const auto& [a, b] : {std::pair{2, 5}, {3, 4}, {0, 1}, {0, 7}}) {
    for (const char* which : {"full", "plain"}) {
      const fs::path folder = Copy(which);
      Swap(folder, "rgb", ".png", a, b);
      const auto failures = Failures(folder);
      for (const int k : {a, b}) {
        EXPECT_THAT(failures, Contains(testing::AllOf(HasSubstr("pictures"), HasSubstr("rgb " + Stamp(k)))))
            << which << a << b;
      }
      fs::remove_all(folder);
    }
  }
}

// All images of the next frame: consistent with one another; the offset appears only with depth and poses.
TEST_F(VerifyTest, AllPicturesOneFrameLate) {
  const fs::path folder = Copy("plain");
  for (int k = 0; k < 7; ++k) {
    fs::copy_file(folder / "rgb" / (Stamp(k + 1) + ".png"), folder / "rgb" / (Stamp(k) + ".png"),
                  fs::copy_options::overwrite_existing);
  }
  EXPECT_THAT(Failures(folder), Contains(HasSubstr("pictures against neighbours: offset")));
}

TEST_F(VerifyTest, TwoDepthFilesSwapped) {
  for (const auto& [which, stream, extension] :
       {std::tuple{"full", "depth_exr", ".exr"}, {"full", "depth", ".png"}, {"plain", "depth", ".png"}}) {
    const fs::path folder = Copy(which);
    Swap(folder, stream, extension, 2, 5);
    const auto failures = Failures(folder);
    for (const int k : {2, 5}) EXPECT_THAT(failures, Contains(HasSubstr(": depth " + Stamp(k)))) << which << stream;
    fs::remove_all(folder);
  }
}

TEST_F(VerifyTest, AFlowOfAnotherFrame) {
  for (const std::string stream : {"flow", "flow_backward"}) {
    const fs::path folder = Copy();
    fs::copy_file(folder / stream / (Stamp(4) + ".flo"), folder / stream / (Stamp(3) + ".flo"),
                  fs::copy_options::overwrite_existing);
    EXPECT_THAT(Failures(folder), Contains(HasSubstr(stream + " against depth and poses: " + stream + " " + Stamp(3))));
    fs::remove_all(folder);
  }
}

TEST_F(VerifyTest, APoseLineAltered) {
  for (std::size_t axis = 1; axis <= 3; ++axis) {  // 1 mm
    for (const char* which : {"full", "plain"}) {
      const fs::path folder = Copy(which);
      Alter(folder / "groundtruth.txt", 5, axis, 1e-3);
      EXPECT_THAT(Failures(folder),
                  Contains(testing::AllOf(HasSubstr("velocity against poses: position"), HasSubstr(Stamp(4)))))
          << which << axis;
      fs::remove_all(folder);
    }
  }
  // 0.1 degree: each of x, y, z of the quaternion by half of it; its length stays 1 to 1e-3.
  for (std::size_t axis = 4; axis <= 6; ++axis) {
    const fs::path folder = Copy();
    Alter(folder / "groundtruth.txt", 5, axis, 0.5 * 0.1 * 3.14159265 / 180);
    const auto failures = Failures(folder);
    EXPECT_THAT(failures,
                Contains(testing::AllOf(HasSubstr("velocity against poses: orientation"), HasSubstr(Stamp(4)))));
    EXPECT_THAT(failures, Contains(HasSubstr("flow against depth and poses: flow " + Stamp(4))));
    fs::remove_all(folder);
  }
}

TEST_F(VerifyTest, ANormalWithTheOtherSign) {
  const fs::path folder = Copy(), file = folder / "normals" / (Stamp(3) + ".exr");
  cv::Mat normals = ReadPicture(file);
  normals.at<cv::Vec3f>(60, 80) *= -1.0f;
  const std::span<const float> numbers(reinterpret_cast<const float*>(normals.data), normals.total() * 3);
  WriteBytes(file, sim::EncodeExr(numbers, normals.cols, normals.rows, 3, true));
  EXPECT_THAT(Failures(folder), Contains(HasSubstr("normals: unit, towards the camera: normals " + Stamp(3))));
  // x mirrored in all normals: still of unit length and towards the camera.
  normals = ReadPicture(rendered_->path() / "full" / "normals" / (Stamp(3) + ".exr"));
  for (int i = 0; i < static_cast<int>(normals.total()); ++i) normals.at<cv::Vec3f>(i)[0] *= -1.0f;
  const std::span<const float> mirrored(reinterpret_cast<const float*>(normals.data), normals.total() * 3);
  WriteBytes(file, sim::EncodeExr(mirrored, normals.cols, normals.rows, 3, true));
  EXPECT_THAT(Failures(folder), Contains(HasSubstr("normals against depth: share beyond: normals " + Stamp(3))));
}

TEST_F(VerifyTest, DistanceIdsOcclusionAndLandmarks) {
  const fs::path folder = Copy();
  Swap(folder, "distance", ".exr", 2, 3);
  Swap(folder, "occlusion", ".png", 1, 6);
  Alter(folder / "landmark_tracks.txt", 100, 2, 1e-6);
  Write(folder / "surfaces.txt", "# id mesh\n1 all\n");
  const auto failures = Failures(folder);
  EXPECT_THAT(failures, Contains(HasSubstr("distance against depth: distance " + Stamp(2))));
  EXPECT_THAT(failures, Contains(HasSubstr("occlusion against depth: share beyond: occlusion " + Stamp(1))));
  EXPECT_THAT(failures, Contains(HasSubstr("landmark_tracks against landmarks, poses: ")));
  EXPECT_THAT(failures, Contains(HasSubstr("surface_id: where there is depth, in legend: ")));
}

TEST_F(VerifyTest, VelocityAccelerationAndImu) {
  const fs::path folder = Copy();
  Alter(folder / "velocity.txt", 5, 1, 2e-3);
  Alter(folder / "acceleration.txt", 4, 6, 0.1);
  const auto failures = Failures(folder);
  EXPECT_THAT(failures, Contains(testing::AllOf(HasSubstr("velocity against poses: position"), HasSubstr(Stamp(4)))));
  EXPECT_THAT(failures, Contains(testing::AllOf(HasSubstr("angular acceleration against rate"), HasSubstr(Stamp(3)))));
  const fs::path other = Copy("plain");
  fs::create_directory(other / "imu0");
  for (const char* file : {"data.csv", "sensor.yaml"})
    fs::copy_file(rendered_->path() / "full" / "imu0" / file, other / "imu0" / file);
  EXPECT_THAT(Failures(other), IsEmpty());
  std::string yaml = Read(other / "imu0" / "sensor.yaml");
  yaml.replace(yaml.find("-9.81"), 5, "-9.71");
  Write(other / "imu0" / "sensor.yaml", yaml);
  EXPECT_THAT(Failures(other), Contains(HasSubstr("IMU against poses: velocity")));
}

// Scene with moving objects, at 160 x 120.
void RenderMoving(const fs::path& folder, const std::string& truth) {
  Render(folder,
         {{"truth", truth},
          {"landmarks.count", "200"},
          {"camera", "{width: 160, height: 120, fx: 131.25, fy: 131.25, cx: 79.5, cy: 59.5}"},
          {"sensor.time_samples", "4"}},
         8, "moving.yaml");
}
std::string AllAndMoving() { return std::string(kAll).replace(0, 1, "[moving, "); }

// Each kind of wrong label, in the scene with objects.
TEST_F(VerifyTest, Labels) {
  const fs::path good = here_.path() / "labels";
  RenderMoving(good, "[depth, instance, semantic, boxes]");
  for (const Check& check : Verify(good)) EXPECT_THAT(check.failures(), IsEmpty()) << check.name();
  const auto spoilt = [&](const std::string& stream, const std::function<void(const fs::path&)>& spoil) {
    const fs::path bad = here_.path() / "bad";
    fs::remove_all(bad);
    fs::copy(good, bad, fs::copy_options::recursive);
    spoil(bad / stream / (Stamp(2) + (stream == "boxes" ? ".csv" : ".png")));
    return Failures(bad);
  };
  const auto with_pixel = [&](const std::string& stream, const auto& change) {
    return spoilt(stream, [&](const fs::path& file) {
      cv::Mat picture = ReadPicture(file);
      change(picture);
      WriteBytes(file, picture.depth() == CV_8U
                           ? sim::EncodePng(picture.cols, picture.rows, 1, std::span(picture.data, picture.total()))
                           : sim::EncodePng(picture.cols, picture.rows, 1,
                                            std::span(picture.ptr<std::uint16_t>(), picture.total())));
    });
  };
  // One pixel of another instance contradicts the boxes; one of an unknown instance or another class, the legend.
  EXPECT_THAT(with_pixel("instance", [](cv::Mat& ids) { ids.at<std::uint16_t>(0, 0) = 2; }),
              Contains(HasSubstr("boxes against the instances: boxes/" + Stamp(2) + ".csv instance 2")));
  EXPECT_THAT(with_pixel("instance", [](cv::Mat& ids) { ids.at<std::uint16_t>(0, 0) = 9; }),
              Contains(HasSubstr("as the legend: instance " + Stamp(2))));
  EXPECT_THAT(with_pixel("semantic", [](cv::Mat& classes) { classes.at<std::uint8_t>(5, 5) ^= 1; }),
              Contains(HasSubstr("as the legend: instance " + Stamp(2))));
  EXPECT_THAT(spoilt("boxes", [](const fs::path& file) { Alter(file, 2, 4, 1, ','); }),
              Contains(HasSubstr("boxes against the instances: boxes/" + Stamp(2) + ".csv instance 2")));
  EXPECT_THAT(spoilt("boxes", [](const fs::path& file) { Alter(file, 2, 9, 0.3, ','); }),
              Contains(HasSubstr("lies in its instance's box: boxes/" + Stamp(2))));
  EXPECT_THAT(spoilt("boxes", [](const fs::path& file) { fs::remove(file); }),
              Contains(HasSubstr("boxes against the instances")));
}

TEST_F(VerifyTest, MovingObjectsPass) {
  RenderMoving(here_.path() / "moving", AllAndMoving());
  for (const Check& check : Verify(here_.path() / "moving")) {
    EXPECT_GT(check.count(), 0u) << check.name();
    EXPECT_THAT(check.failures(), IsEmpty()) << check.name() << ": " << check.value() << " > " << check.bound();
  }
  // Without the mask any pixel may belong to an object.
  fs::remove(here_.path() / "moving" / "moving.txt");
  EXPECT_THAT(Failures(here_.path() / "moving"), IsEmpty());
}

TEST_F(VerifyTest, MovingObjectsAndMasksThatAreWrong) {
  const fs::path whole = here_.path() / "whole";
  RenderMoving(whole, AllAndMoving());
  const auto spoilt = [&](const char* name) {
    fs::copy(whole, here_.path() / name, fs::copy_options::recursive);
    return here_.path() / name;
  };
  for (std::size_t axis = 1; axis <= 3; ++axis) {  // 1 mm
    const fs::path folder = spoilt("shifted");
    Alter(folder / "objects" / "parcel.txt", 5, axis, 1e-3);
    const auto failures = Failures(folder);
    EXPECT_THAT(failures, Contains(HasSubstr("flow on objects against their poses: flow " + Stamp(4)))) << axis;
    EXPECT_THAT(failures, testing::Not(Contains(HasSubstr("flow against depth")))) << "the world is right";
    fs::remove_all(folder);
  }
  fs::path folder = spoilt("swapped");
  Swap(folder, "moving", ".png", 1, 6);
  EXPECT_THAT(Failures(folder), Contains(HasSubstr("moving: pixels that move as the others: moving " + Stamp(1))));

  // One pixel, either way.
  for (const int value : {0, 255}) {
    folder = spoilt(value == 0 ? "less" : "more");
    const fs::path file = folder / "moving" / (Stamp(3) + ".png");
    cv::Mat mask = ReadPicture(file);
    int flipped = -1;
    for (int i = 160 * 30; i < static_cast<int>(mask.total()) && flipped < 0; ++i) {
      if (mask.data[i] != value) flipped = i;
    }
    mask.data[flipped] = static_cast<std::uint8_t>(value);
    WriteBytes(file, sim::EncodePng(mask.cols, mask.rows, 1, std::span(mask.data, mask.total())));
    EXPECT_THAT(Failures(folder), Contains(HasSubstr("moving: pixels that move as the others: moving " + Stamp(3))))
        << value;
  }

  folder = spoilt("short");
  std::vector<std::string> lines = Lines(folder / "objects" / "globe.txt");
  lines.pop_back();
  WriteLines(folder / "objects" / "globe.txt", lines);
  EXPECT_THAT(Failures(folder),
              Contains(HasSubstr("stamps: increasing, the same in all lists: objects/globe.txt: ends early")));

  folder = spoilt("none");
  fs::remove_all(folder / "objects");
  EXPECT_THAT(Failures(folder), Contains(HasSubstr("pixels of objects, of which there are none")));
}

TEST_F(VerifyTest, FilesThatAreNotAsTheyShould) {
  const fs::path folder = Copy();
  fs::remove(folder / "depth" / (Stamp(2) + ".png"));
  fs::resize_file(folder / "flow" / (Stamp(3) + ".flo"), 1000);
  fs::copy_file(folder / "occlusion" / (Stamp(3) + ".png"), folder / "rgb" / (Stamp(3) + ".png"),
                fs::copy_options::overwrite_existing);
  Write(folder / "distance" / (Stamp(1) + ".exr"), "no picture");
  std::vector<std::string> lines = Lines(folder / "velocity.txt");
  lines[3] += " 7";
  WriteLines(folder / "velocity.txt", lines);
  const auto failures = Failures(folder);
  for (const std::string& name :
       {"depth/" + Stamp(2) + ".png: is not there", "flow/" + Stamp(3) + ".flo: is not as long",
        "distance/" + Stamp(1) + ".exr: ", std::string("velocity.txt:4: 8 words, not 7")}) {
    EXPECT_THAT(failures, Contains(testing::AllOf(HasSubstr("files: "), HasSubstr(name)))) << name;
  }
  EXPECT_THAT(failures, Contains(HasSubstr("pictures"))) << "a mask is no picture of the scene";
  EXPECT_THROW(Verify(folder / "rgb"), std::runtime_error);
}

// Implausible image sizes are refused.
TEST_F(VerifyTest, ACameraOfAnySizeIsRefused) {
  const fs::path folder = Copy("plain");
  const std::string camera = Read(folder / "camera.yaml");
  for (const auto& [size, said] :
       {std::pair{"width: 40000\nheight: 120\n", "camera.yaml: 40000 x 120 pixels: a side may have 32768"},
        {"width: 32000\nheight: 1000\n", "camera.yaml: 32000 x 1000 pixels in "}}) {
    const std::string before = "width: 160\nheight: 120\n";
    std::string changed = camera;
    ASSERT_TRUE(changed.starts_with(before)) << camera;
    changed.replace(0, before.size(), size);
    for (const char* focal : {"fx: ", "fy: "}) changed.replace(changed.find(focal), 4, std::string(focal) + "1000");
    Write(folder / "camera.yaml", changed);
    try {
      Verify(folder);
      ADD_FAILURE() << size;
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), HasSubstr(said));
    }
  }
}

// Two cameras side by side on a smooth path, with an IMU away from the body's origin.
void RenderRig(const fs::path& folder, const std::vector<std::pair<std::string, std::string>>& more = {}) {
  const std::string lens = "width: 160, height: 120, fx: 131.25, fy: 131.25, cx: 79.5, cy: 59.5, ";
  std::vector<std::pair<std::string, std::string>> settings = {
      {"cameras", "[{" + lens + "position: [-0.06, 0, 0.02]}, {" + lens + "position: [0.06, 0, 0.02]}]"},
      {"truth", "[depth, depth_exr, disparity, imu, instance, boxes]"},
      {"imu.rate", "1 kHz"},
      {"imu.position", "[0.02, -0.01, 0.03]"},
      {"imu.orientation", "[0.5, 0.5, 0.5, 0.5]"}};
  settings.insert(settings.end(), more.begin(), more.end());
  std::string text = Read(fs::path(VOBENCH_SOURCE_DIR) / "scenes/tiny.yaml");
  const std::size_t camera = text.find("\ncamera:");
  text.erase(camera, text.find('\n', camera + 1) - camera);
  const fs::path scenario = folder.parent_path() / "rig.yaml";
  for (std::size_t at = 0; (at = text.find("file: room/", at)) != std::string::npos; at += 6)
    text.insert(at + 6, std::string(VOBENCH_SOURCE_DIR) + "/scenes/");
  Write(scenario, text);
  Render(folder, settings, 6, scenario);
}

void Replace(const fs::path& file, const std::string& from, const std::string& to) {
  std::string text = Read(file);
  ASSERT_NE(text.find(from), std::string::npos) << file << ": " << from;
  Write(file, text.replace(text.find(from), from.size(), to));
}

TEST_F(VerifyTest, ARigAndEachFaultOfOne) {
  const fs::path good = here_.path() / "rig", bad = here_.path() / "bad";
  RenderRig(good);
  std::size_t made = 0;
  for (const Check& check : Verify(good)) {
    EXPECT_THAT(check.failures(), IsEmpty()) << check.name() << ": " << check.value() << " > " << check.bound();
    made += check.count() > 0;
  }
  EXPECT_GE(made, 30u);
  const auto spoilt = [&](const std::function<void()>& spoil) {
    fs::remove_all(bad);
    fs::copy(good, bad, fs::copy_options::recursive);
    spoil();
    return Failures(bad);
  };
  const std::string left = "position: [-0.06, 0, 0.02]", right = "position: [0.06, 0, 0.02]";
  // T_BC of the other camera, and T_CB in its place.
  EXPECT_THAT(spoilt([&] {
                Replace(bad / "rig.yaml", left, "the left");
                Replace(bad / "rig.yaml", right, left);
                Replace(bad / "rig.yaml", "the left", right);
              }),
              Contains(HasSubstr("cameras' poses against the body's: cam0/groundtruth.txt")));
  EXPECT_THAT(spoilt([&] { Replace(bad / "rig.yaml", right, "position: [-0.06, 0, -0.02]"); }),
              Contains(HasSubstr("cameras' poses against the body's: cam1/groundtruth.txt")));
  // Depth of one camera in the other's folder; all poses are correct.
  EXPECT_THAT(spoilt([&] {
                fs::remove_all(bad / "cam1/depth_exr");
                fs::copy(bad / "cam0/depth_exr", bad / "cam1/depth_exr");
              }),
              Contains(HasSubstr("depth in the first camera: median: cam1")));
  // The lens.
  EXPECT_THAT(spoilt([&] { Replace(bad / "cam1/camera.yaml", "fx: 131.25", "fx: 132.5"); }),
              Contains(HasSubstr("depth in the first camera: median: cam1")));
  EXPECT_THAT(spoilt([&] { Replace(bad / "cam1/camera.yaml", "k1: 0", "k1: 0.02"); }),
              Contains(HasSubstr("depth in the first camera: median: cam1")));
  // An instance; a disparity of another frame; the IMU's orientation.
  EXPECT_THAT(spoilt([&] {
                const fs::path file = bad / "cam1/instance" / (Stamp(2) + ".png");
                cv::Mat ids = ReadPicture(file);
                ids.at<std::uint16_t>(60, 80) = 0;
                WriteBytes(file,
                           sim::EncodePng(ids.cols, ids.rows, 1, std::span(ids.ptr<std::uint16_t>(), ids.total())));
              }),
              Contains(HasSubstr("cam1: labels: where there is depth, as the legend")));
  EXPECT_THAT(spoilt([&] { Swap(bad / "cam0", "disparity", ".exr", 2, 3); }),
              Contains(HasSubstr("disparity against depth and the base: disparity " + Stamp(2))));
  EXPECT_THAT(spoilt([&] { Replace(bad / "imu0/sensor.yaml", "[0.5, 0.5, 0.5, 0.5]", "[0.5, -0.5, 0.5, 0.5]"); }),
              Contains(HasSubstr("body: IMU against poses")));
}

TEST_F(VerifyTest, TheSignOfATriggerOffset) {
  const fs::path good = here_.path() / "rig";
  RenderRig(good, {{"cameras.1.trigger_offset", "4 ms"}, {"truth", "[depth, depth_exr, imu]"}});
  EXPECT_THAT(Failures(good), IsEmpty());
  Replace(good / "rig.yaml", "trigger_offset: 0.004 s", "trigger_offset: -0.004 s");
  EXPECT_THAT(Failures(good), Contains(HasSubstr("stamps less the trigger offsets: cam1")));
}

// Images taken before their stamps, on a rig whose files agree.
TEST_F(VerifyTest, PicturesOfAnotherTriggerOffset) {
  const fs::path good = here_.path() / "rig", other = here_.path() / "other/rig";
  fs::create_directories(other.parent_path());
  RenderRig(good, {{"cameras.1.trigger_offset", "8 ms"}, {"truth", "[depth, depth_exr]"}});
  RenderRig(other, {{"truth", "[depth, depth_exr]"}});
  for (const fs::directory_entry& entry : fs::directory_iterator(other / "cam1/depth_exr")) {
    char stamp[32];
    std::snprintf(stamp, sizeof stamp, "%.9f.exr", std::stod(entry.path().stem()) + 0.008);
    ASSERT_TRUE(fs::copy_file(entry.path(), good / "cam1/depth_exr" / stamp, fs::copy_options::overwrite_existing));
  }
  EXPECT_THAT(Failures(good), Contains(HasSubstr("depth in the first camera: median: cam1")));
}

// Rough (sampled) path: the camera's lever arm turns with the body.
TEST_F(VerifyTest, ARigOnASampledPath) {
  const fs::path folder = here_.path() / "rig";
  RenderRig(folder,
            {{"truth", "[depth, imu]"},
             {"imu.reading", "mean"},
             {"trajectory",
              "{type: sampled, start: {position: [2.0, 1.41, 2.55], look_at: [2.35, 1.1, 0.0]}, position_noise: "
              "0.05, orientation_noise: 2}"}});
  EXPECT_THAT(Failures(folder), IsEmpty());
}

}  // namespace
}  // namespace verification
