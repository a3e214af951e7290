#include "sim/sequence/streams.h"

#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <map>
#include <opencv2/imgcodecs.hpp>

#include "sim/render/surface_tracer.h"
#include "sim/sensor/depth_noise.h"
#include "sim/sequence/encode.h"
#include "sim/sequence/flow.h"
#include "tests/unit/sim/small_world.h"

namespace sim {
namespace {

using testing::HasSubstr;
using testing::StartsWith;
using Streams = std::set<TruthStream>;

Streams All() {
  Streams all;
  for (int i = 0; i <= static_cast<int>(TruthStream::imu); ++i) all.insert(static_cast<TruthStream>(i));
  all.erase(TruthStream::disparity);  // of rigs
  return all;
}

std::map<std::string, std::vector<std::uint8_t>> ByName(const std::vector<StreamFile>& files) {
  std::map<std::string, std::vector<std::uint8_t>> map;
  for (const StreamFile& file : files) map[file.path] = file.bytes;
  EXPECT_EQ(map.size(), files.size());
  return map;
}

std::vector<float> ReadExr(const std::filesystem::path& path, const std::vector<std::string>& channels, int pixels,
                           int width) {
  Imf::InputFile file(path.c_str());
  std::vector<float> values(channels.size() * static_cast<std::size_t>(pixels));
  Imf::FrameBuffer buffer;
  const std::size_t step = channels.size() * sizeof(float);
  for (std::size_t c = 0; c < channels.size(); ++c) {
    buffer.insert(channels[c], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data() + c), step,
                                          step * static_cast<std::size_t>(width)));
  }
  file.setFrameBuffer(buffer);
  file.readPixels(file.header().dataWindow().min.y, file.header().dataWindow().max.y);
  return values;
}

TEST(TruthStreams, EachHasAName) {
  TruthParams truth;
  truth.streams = All();
  truth.streams.insert(TruthStream::disparity);
  settings::FieldRows table;
  Visit(table, truth);
  EXPECT_EQ(table.rows.at(0).value, table.rows.at(0).range);
  EXPECT_THAT(table.rows.at(0).value, StartsWith("depth, depth_exr, depth_kinect, distance, "));
}

TEST(TruthStreams, FilesOfAFrame) {
  const SmallWorld world;
  const Simulator simulator(LoadScenario(world.scenario()), 1), parallel(LoadScenario(world.scenario()), 3);
  const auto first = ByName(FrameStreams(simulator, 0, All())), middle = ByName(FrameStreams(simulator, 4, All())),
             last = ByName(FrameStreams(simulator, 8, All()));
  EXPECT_EQ(middle.size(), 14u);
  EXPECT_EQ(first.size(), 12u);
  EXPECT_FALSE(first.contains("flow_backward/0.000000000.flo"));
  EXPECT_EQ(last.size(), 12u);
  EXPECT_FALSE(last.contains("flow/0.266666667.flo"));
  EXPECT_TRUE(middle == ByName(FrameStreams(parallel, 4, All())));
  EXPECT_EQ(FrameStreams(simulator, 4, {TruthStream::normals, TruthStream::imu}).size(), 1u);
  EXPECT_TRUE(FrameStreams(simulator, 4, {}).empty());
  for (const auto& [name, bytes] : middle) {
    EXPECT_TRUE(StreamNames().contains(name.substr(0, name.find('/')))) << name;
  }
}

TEST(TruthStreams, WhatIsInTheFiles) {
  const SmallWorld world;
  const Simulator simulator(LoadScenario(world.scenario()), 1);
  const auto files = ByName(FrameStreams(simulator, 4, All()));
  const std::string stamp = "/0.133333333";
  for (const auto& [name, bytes] : files) {
    std::filesystem::create_directories((world.folder.path() / name).parent_path());
    world.folder.Write(name, {bytes.begin(), bytes.end()});
  }
  const auto exr = [&](const std::string& stream, const std::vector<std::string>& channels) {
    return ReadExr(world.folder.path() / (stream + stamp + ".exr"), channels, 64 * 48, 64);
  };
  const auto depth = exr("depth_exr", {"Y"}), distance = exr("distance", {"Y"}),
             normals = exr("normals", {"R", "G", "B"});
  EXPECT_EQ(depth, simulator.Depth(4));
  const cv::Mat kinect = cv::imdecode(files.at("depth_kinect" + stamp + ".png"), cv::IMREAD_UNCHANGED);
  ASSERT_EQ(kinect.type(), CV_16UC1);
  const std::vector<float> noisy = WithKinectNoise(depth, 64, 48, simulator.scenario().seed, 4);
  int changed = 0;
  for (std::size_t i = 0; i < noisy.size(); ++i) {
    ASSERT_EQ(kinect.at<std::uint16_t>(static_cast<int>(i)), std::lround(5000 * noisy[i]));
    changed += noisy[i] != depth[i];
  }
  EXPECT_GT(changed, 2000);
  const cv::Mat ids = cv::imdecode(files.at("surface_id" + stamp + ".png"), cv::IMREAD_UNCHANGED);
  ASSERT_EQ(ids.type(), CV_16UC1);
  const auto& flo = files.at("flow" + stamp + ".flo");
  ASSERT_EQ(flo.size(), 12u + 8 * 64 * 48);
  EXPECT_EQ(std::memcmp(flo.data(), "PIEH\x40\0\0\0\x30\0\0\0", 12), 0);

  const Truth truth = simulator.TruthAt(4), next = simulator.TruthAt(5);
  const glm::dvec3 normal = glm::conjugate(truth.q_WC) * glm::dvec3(0, 0, 1);  // the wall's, towards the camera
  int seen = 0;
  for (std::size_t i = 0; i < 64 * 48; ++i) {
    const double x = (static_cast<double>(i % 64) - 31.5) / 52, y = (static_cast<double>(i / 64) - 23.5) / 52;
    const glm::dvec3 ray(x, y, 1), ray_W = truth.q_WC * ray;
    const double z = (-2 - truth.p_WC.z) / ray_W.z;
    const glm::dvec3 X_W = truth.p_WC + z * ray_W;
    if (std::abs(std::abs(X_W.x) - 2) < 1e-5 || std::abs(std::abs(X_W.y) - 1.5) < 1e-5) continue;
    const bool wall = std::abs(X_W.x) < 2 && std::abs(X_W.y) < 1.5;
    seen += wall;
    ASSERT_EQ(ids.at<std::uint16_t>(static_cast<int>(i)), wall ? 1 : 0);
    float uv[2];
    std::memcpy(uv, flo.data() + 12 + 8 * i, 8);
    if (!wall) {
      ASSERT_EQ(depth[i], 0);
      ASSERT_EQ(distance[i], 0);
      ASSERT_EQ(normals[3 * i + 2], 0);
      ASSERT_EQ(uv[0], kUnknownFlow);
      continue;
    }
    ASSERT_NEAR(depth[i] / z, 1, 2e-7);
    ASSERT_NEAR(distance[i] / (z * glm::length(ray)), 1, 2e-7);
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(normals[3 * i + static_cast<std::size_t>(c)], normal[c], 1e-7);
    const glm::dvec3 X_C = glm::conjugate(next.q_WC) * (X_W - next.p_WC);
    ASSERT_NEAR(uv[0], 52 * (X_C.x / X_C.z - x), 3e-6);
    ASSERT_NEAR(uv[1], 52 * (X_C.y / X_C.z - y), 3e-6);
  }
  EXPECT_GT(seen, 2000);
}

TEST(TruthStreams, ListsAndTexts) {
  const SmallWorld world;
  const Simulator simulator(LoadScenario(world.scenario(), {{"imu.rate", "100 Hz"}, {"landmarks.count", "20"}}), 1);
  const auto text = [](const std::vector<std::uint8_t>& bytes) { return std::string(bytes.begin(), bytes.end()); };
  const auto all = ByName(SequenceStreams(simulator, 0, 9, All())),
             part = ByName(SequenceStreams(simulator, 2, 4, All()));
  EXPECT_THAT(text(all.at("flow.txt")), StartsWith("# timestamp filename\n0.000000000 flow/0.000000000.flo\n"));
  EXPECT_THAT(text(all.at("flow.txt")), testing::Not(HasSubstr("0.266666667")));
  EXPECT_THAT(text(part.at("flow.txt")), HasSubstr("0.100000000 flow/0.100000000.flo\n"));
  EXPECT_EQ(text(part.at("depth.txt")),
            "# timestamp filename\n0.066666667 depth/0.066666667.png\n0.100000000 depth/0.100000000.png\n");
  EXPECT_THAT(text(all.at("surfaces.txt")), StartsWith("# id mesh; 0: nothing\n1 "));
  EXPECT_THAT(text(all.at("imu0/data.csv")), StartsWith("#timestamp [ns],w_RS_S_x [rad s^-1],"));
  EXPECT_THAT(text(all.at("imu0/data.csv")), HasSubstr("\n10000000,"));
  EXPECT_THAT(text(part.at("imu0/data.csv")), HasSubstr("s^-2]\n70000000,"));
  for (const char* name : {"acceleration.txt", "landmark_tracks.txt"}) {
    const std::string whole = text(all.at(name)), some = text(part.at(name));
    EXPECT_THAT(whole, HasSubstr(some.substr(some.find('\n') + 1))) << name;
  }
  EXPECT_EQ(all.at("landmarks.txt"), part.at("landmarks.txt"));
  for (const auto& [name, bytes] : all) EXPECT_TRUE(StreamNames().contains(name.substr(0, name.find('/')))) << name;
}

}  // namespace
}  // namespace sim
