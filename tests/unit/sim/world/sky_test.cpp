// Sky in closed form and from images, and the flicker of lamps.
#include "sim/world/sky.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <numbers>
#include <opencv2/imgcodecs.hpp>

#include "sim/world/light.h"
#include "tests/unit/sim/world/files.h"

namespace sim::test {
namespace {

using testing::HasSubstr;

// Float channels, the data window away from (0, 0).
void WriteExr(const std::filesystem::path& path, const cv::Mat& picture) {
  const Imath::Box2i window({3, 5}, {3 + picture.cols - 1, 5 + picture.rows - 1});
  Imf::Header header(window, window);
  Imf::FrameBuffer buffer;
  const std::size_t step = picture.elemSize(), row = picture.step[0];
  char* base = reinterpret_cast<char*>(picture.data) - 3 * step - 5 * row;
  for (const char* name : {"B", "G", "R"}) {
    header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    buffer.insert(name, Imf::Slice(Imf::FLOAT, base, step, row));
    base += sizeof(float);
  }
  Imf::OutputFile file(path.c_str(), header);
  file.setFrameBuffer(buffer);
  file.writePixels(picture.rows);
}

TEST(Sky, Gradient) {
  const Sky sky{{3, 3, 3}, {1, 2, 3}, {0, 0, 0}, 0, 0, {}, 0.0};
  EXPECT_EQ(sky.Radiance({0, 1, 0}), glm::dvec3(3));
  EXPECT_EQ(sky.Radiance({0, -1, 0}), glm::dvec3(0));
  EXPECT_EQ(sky.Radiance({0.6, 0, 0.8}), glm::dvec3(1, 2, 3));
  EXPECT_EQ(sky.Radiance({0.6, 0.5, 0.6}), glm::dvec3(2, 2.5, 3));
}

// Orientation of a sky image of 8 x 4 pixels: its middle is -z, to its right +x, its top the zenith.
TEST(Sky, PictureIsTheRightWayRound) {
  const Folder folder;
  cv::Mat picture(4, 8, CV_32FC3);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 8; ++x)
      picture.at<cv::Vec3f>(y, x) = {0.0f, static_cast<float>(y), static_cast<float>(x)};  // blue, green, red
  }
  std::vector<std::uint8_t> bytes;
  cv::imencode(".hdr", picture, bytes);
  folder.Write("sky.hdr", {bytes.begin(), bytes.end()});
  WriteExr(folder.path() / "sky.exr", picture);
  for (const char* name : {"sky.hdr", "sky.exr"}) {
    SCOPED_TRACE(name);
    SkyDescription description;
    description.file = folder.path() / name;
    description.strength = 2;
    Sky sky = LoadSky(description);
    const auto towards = [](double turns, double polar_turns) {
      const double a = 2 * std::numbers::pi * turns, p = 2 * std::numbers::pi * polar_turns;
      return glm::dvec3(std::sin(p) * std::sin(a), std::cos(p), -std::sin(p) * std::cos(a));
    };
    for (int y = 0; y < 4; ++y) {
      for (int x = 0; x < 8; ++x) {
        const glm::dvec3 seen = sky.Radiance(towards((x + 0.5) / 8 - 0.5, (y + 0.5) / 8));
        EXPECT_NEAR(seen.x, 2 * x, 0.05) << x << ", " << y;  // Radiance HDR has 8 bits
        EXPECT_NEAR(seen.y, 2 * y, 0.05) << x << ", " << y;
      }
    }
    EXPECT_NEAR(sky.Radiance(towards(0.5, 0.25)).x, 2 * 3.5, 0.05) << "the seam, behind: between 7 and 0";
    sky.turn = 0.25;
    EXPECT_NEAR(sky.Radiance(towards(0.0625, 0.25)).x, 2 * 6, 0.05);
  }
}

// Values are to be divided by the product of the exposures of the header.
TEST(Sky, ExposureOfARadiancePicture) {
  const Folder folder;
  std::vector<std::uint8_t> bytes;
  cv::imencode(".hdr", cv::Mat(2, 4, CV_32FC3, cv::Scalar(3, 3, 3)), bytes);
  std::string text(bytes.begin(), bytes.end());
  text.insert(text.find('\n') + 1, "EXPOSURE=2.0\nEXPOSURE= 0.75\nEXPOSURE=\nEXPOSURE=none\n");
  SkyDescription description;
  description.file = folder.Write("sky.hdr", text);
  EXPECT_NEAR(LoadSky(description).Radiance({0, 1, 0}).x, 2, 0.02);
}

TEST(Sky, FilesThatAreNone) {
  const Folder folder;
  const auto what = [&](const std::filesystem::path& file) -> std::string {
    SkyDescription description;
    description.file = file;
    try {
      LoadSky(description);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(what(folder.path() / "none.hdr"), HasSubstr("none.hdr: cannot be opened"));
  EXPECT_THAT(what(folder.Write("text.hdr", "not a picture")), HasSubstr("text.hdr"));
  EXPECT_THAT(what(folder.Write("empty.png", "")), HasSubstr("empty.png"));
  WriteExr(folder.path() / "cut.exr", cv::Mat(64, 64, CV_32FC3, cv::Scalar(1, 1, 1)));
  std::filesystem::resize_file(folder.path() / "cut.exr", std::filesystem::file_size(folder.path() / "cut.exr") / 2);
  EXPECT_THAT(what(folder.path() / "cut.exr"), HasSubstr("cut.exr: cannot be read: "));
  WriteExr(folder.path() / "dark.exr", cv::Mat(1, 2, CV_32FC3, cv::Scalar(0, 0, -1)));
  EXPECT_THAT(what(folder.path() / "dark.exr"), HasSubstr("dark.exr: pixel (0, 0) is negative"));
}

TEST(Flicker, MeanIsOne) {
  const Flicker flicker{100, 0.3, 0.1};
  double mean = 0, low = 9, high = 0;
  for (int i = 0; i < 1000; ++i) {
    const double factor = FlickerFactor(flicker, 0.01 * i / 1000);
    mean += factor / 1000;
    low = std::min(low, factor);
    high = std::max(high, factor);
  }
  EXPECT_NEAR(mean, 1, 1e-12);
  EXPECT_NEAR(low, 0.7, 1e-4);
  EXPECT_NEAR(high, 1.3, 1e-4);
  EXPECT_NEAR(FlickerFactor(flicker, 0.123), 1 + 0.3 * std::sin(2 * std::numbers::pi * (12.3 + 0.1)), 1e-12);
  EXPECT_EQ(FlickerFactor({}, 5), 1);
}

// Mean of the flicker over an interval against Simpson's rule.
TEST(Flicker, MeanOverAnInterval) {
  const Flicker flicker{100, 0.4, 0.3};
  for (const double width : {1e-4, 0.003, 0.01, 0.0123}) {
    double sum = 0;
    const int n = 2000;
    for (int i = 0; i <= n; ++i)
      sum += (i == 0 || i == n ? 1
              : i % 2 == 1     ? 4
                               : 2) *
             FlickerFactor(flicker, 0.5 + width * (static_cast<double>(i) / n - 0.5));
    EXPECT_NEAR(FlickerFactor(flicker, 0.5, width), sum / (3 * n), 1e-9) << width;
  }
  EXPECT_NEAR(FlickerFactor(flicker, 0.5, 0.01), 1, 1e-12) << "a whole period";
}

}  // namespace
}  // namespace sim::test
