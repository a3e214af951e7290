// Round trip of PNG files: OpenCV (libpng) decodes the same samples, pngcheck finds no fault.
#include <gtest/gtest.h>
#include <libdeflate.h>

#include <cstdlib>
#include <numeric>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <tuple>

#include "sim/random/random.h"
#include "sim/sequence/encode.h"
#include "tests/unit/sim/temporary_folder.h"

namespace sim {
namespace {

enum class Picture { zeros, ramp, noise };

// Sample i of a picture, from 0 to `largest`.
std::uint32_t Sample(Picture picture, std::uint32_t i, std::uint32_t largest) {
  if (picture == Picture::zeros) return 0;
  if (picture == Picture::ramp) return i * 3 % (largest + 1);
  return RandomWords(1, Stream::ray_jitter, i, 0, 0)[0] % (largest + 1);
}

template <class T>
std::vector<T> Samples(Picture picture, int count) {
  std::vector<T> samples;
  for (int i = 0; i < count; ++i) {
    samples.push_back(static_cast<T>(Sample(picture, static_cast<std::uint32_t>(i), std::numeric_limits<T>::max())));
  }
  return samples;
}

// Samples decoded by OpenCV, red first.
template <class T>
std::vector<T> Decoded(const std::vector<std::uint8_t>& png, int width, int height, int channels) {
  cv::Mat image = cv::imdecode(png, cv::IMREAD_UNCHANGED);
  EXPECT_EQ(image.cols, width);
  EXPECT_EQ(image.rows, height);
  EXPECT_EQ(image.type(), CV_MAKETYPE(cv::DataType<T>::depth, channels));
  if (image.empty()) return {};
  if (channels == 3) cv::cvtColor(image, image, cv::COLOR_BGR2RGB);
  return {image.ptr<T>(), image.ptr<T>() + image.total() * static_cast<std::size_t>(channels)};
}

template <class T>
void ExpectTheSameBack(int width, int height, int channels, Picture picture) {
  const std::vector<T> samples = Samples<T>(picture, width * height * channels);
  const auto png = EncodePng(width, height, channels, std::span<const T>(samples));
  EXPECT_TRUE(Decoded<T>(png, width, height, channels) == samples)
      << width << " x " << height << ", " << channels << " channels of " << sizeof(T) << " bytes";
}

TEST(Png, GivesBackEverySample) {
  for (const auto& [width, height] :
       {std::pair{1, 1}, {1, 7}, {7, 1}, {2, 2}, {3, 5}, {31, 33}, {640, 3}, {333, 250}}) {
    for (const int channels : {1, 3}) {
      for (const Picture picture : {Picture::zeros, Picture::ramp, Picture::noise}) {
        ExpectTheSameBack<std::uint8_t>(width, height, channels, picture);
        ExpectTheSameBack<std::uint16_t>(width, height, channels, picture);
      }
    }
  }
}

TEST(Png, OtherReadersFindNoFault) {
  if (std::system("pngcheck -h > /dev/null 2>&1") != 0) GTEST_SKIP() << "pngcheck is not installed";
  const TemporaryFolder folder;
  const auto write = [&](const std::string& name, const std::vector<std::uint8_t>& png) {
    return folder.Write(name, std::string(png.begin(), png.end())).string();
  };
  const auto faults = [](const std::string& file) {
    return std::system(("pngcheck -q '" + file + "' > /dev/null").c_str());
  };
  for (const int channels : {1, 3}) {
    const auto eight = EncodePng(31, 33, channels, Samples<std::uint8_t>(Picture::noise, 31 * 33 * channels));
    const auto sixteen = EncodePng(1, 9, channels, Samples<std::uint16_t>(Picture::ramp, 9 * channels));
    EXPECT_EQ(faults(write("eight.png", eight)), 0);
    EXPECT_EQ(faults(write("sixteen.png", sixteen)), 0);
    auto spoiled = eight;
    spoiled[spoiled.size() / 2] ^= 1;
    EXPECT_NE(faults(write("spoiled.png", spoiled)), 0) << "the check can fail";
  }
}

// Paeth filter against the definition of the standard, in integers.
TEST(Png, PaethFilterIsThatOfTheStandard) {
  constexpr std::size_t kSize = 1000;
  const std::vector<std::uint8_t> row = Samples<std::uint8_t>(Picture::noise, kSize), above(row.rbegin(), row.rend());
  for (const std::size_t pixel : {1u, 2u, 3u, 6u}) {
    std::vector<std::uint8_t> filtered(kSize);
    PaethFilter(row.data(), above.data(), kSize, pixel, filtered.data());
    for (std::size_t i = 0; i < kSize; ++i) {
      const int a = i >= pixel ? row[i - pixel] : 0, b = above[i], c = i >= pixel ? above[i - pixel] : 0;
      const int p = a + b - c;
      const int pa = std::abs(p - a), pb = std::abs(p - b), pc = std::abs(p - c);
      const int predicted = pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
      ASSERT_EQ(filtered[i], static_cast<std::uint8_t>(row[i] - predicted)) << i << ", pixel " << pixel;
    }
  }
}

// Checksums of files: equal on every processor, at any address, for one version of libdeflate.
TEST(Png, BytesAreKnown) {
  if (std::string(LIBDEFLATE_VERSION_STRING) != "1.14") GTEST_SKIP() << "known for libdeflate 1.14 only";
  const auto sum = [](const std::vector<std::uint8_t>& bytes) {  // FNV-1a
    return std::accumulate(bytes.begin(), bytes.end(), std::uint64_t{14695981039346656037u},
                           [](std::uint64_t h, std::uint8_t byte) { return (h ^ byte) * 1099511628211u; });
  };
  EXPECT_EQ(sum(EncodePng(333, 250, 3, Samples<std::uint8_t>(Picture::ramp, 333 * 250 * 3))), 5216211657079208129u);
  EXPECT_EQ(sum(EncodePng(333, 250, 3, Samples<std::uint8_t>(Picture::noise, 333 * 250 * 3))), 6458668393968213311u);
  EXPECT_EQ(sum(EncodePng(640, 480, 1, Samples<std::uint16_t>(Picture::ramp, 640 * 480))), 5950079257380155211u);
}

// Depth beyond the range of 16 bits: a sample of 0, and a text chunk with the range and the number of such pixels.
TEST(Png, DepthBeyondItsRange) {
  const std::vector<float> near = {0.5F, 13.107F, 0.0F, 2.0F}, far = {0.5F, 13.1072F, 90.0F, 2.0F};
  const std::vector<std::uint8_t> of_near = EncodeDepthPng(near, 2, 2), of_far = EncodeDepthPng(far, 2, 2);
  EXPECT_EQ(Decoded<std::uint16_t>(of_near, 2, 2, 1), (std::vector<std::uint16_t>{2500, 65535, 0, 10000}));
  EXPECT_EQ(Decoded<std::uint16_t>(of_far, 2, 2, 1), (std::vector<std::uint16_t>{2500, 0, 0, 10000}));
  const std::string text(of_far.begin(), of_far.end());
  EXPECT_NE(text.find(std::string("tEXtComment\0value / 5000 m; 0: nothing, or one of 2 pixels beyond 13.1071 m", 75)),
            std::string::npos);
  EXPECT_EQ(std::string(of_near.begin(), of_near.end()).find("tEXt"), std::string::npos);
}

TEST(Png, RefusesWhatIsNoPicture) {
  const std::vector<std::uint8_t> six(6);
  EXPECT_THROW(EncodePng(0, 6, 1, six), std::invalid_argument);
  EXPECT_THROW(EncodePng(6, -1, 1, six), std::invalid_argument);
  EXPECT_THROW(EncodePng(3, 1, 2, six), std::invalid_argument);
  EXPECT_THROW(EncodePng(2, 2, 1, six), std::invalid_argument);
  EXPECT_NO_THROW(EncodePng(2, 1, 3, six));
}

}  // namespace
}  // namespace sim
