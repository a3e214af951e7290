#include "sim/world/image_file.h"

#include <gmock/gmock.h>
#include <libdeflate.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "tests/unit/sim/world/files.h"

namespace sim::test {
namespace {

DecodedImage Decode(const std::string& bytes) {
  return DecodeImage({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
}

std::vector<std::uint8_t> Rgb(const DecodedImage& image) { return {image.rgb.begin(), image.rgb.end()}; }

std::string Complaint(const std::string& bytes) {
  try {
    Decode(bytes);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "none";
}

TEST(ImageFile, ColoursAndOrder) {
  cv::Mat picture(2, 3, CV_8UC3, cv::Scalar(30, 20, 10));  // BGR
  picture.at<cv::Vec3b>(0, 1) = {3, 2, 1};
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", picture, bytes);
  const DecodedImage image = DecodeImage(bytes);
  EXPECT_EQ(image.width, 3);
  EXPECT_EQ(image.height, 2);
  EXPECT_THAT(image.rgb, testing::ElementsAre(10, 20, 30, 1, 2, 3, 10, 20, 30, 10, 20, 30, 10, 20, 30, 10, 20, 30));
}

std::string Word(std::uint32_t value) {  // of a PNG
  return {static_cast<char>(value >> 24), static_cast<char>(value >> 16), static_cast<char>(value >> 8),
          static_cast<char>(value)};
}

std::string PngChunk(const std::string& type, const std::string& content) {
  const std::string summed = type + content;
  return Word(static_cast<std::uint32_t>(content.size())) + summed +
         Word(libdeflate_crc32(0, summed.data(), summed.size()));
}

// Nothing behind the end chunk is read, whatever length that chunk has (found by fuzzing).
TEST(ImageFile, WhatFollowsTheEndOfAPng) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", cv::Mat(2, 2, CV_8UC1, cv::Scalar(9)), bytes);
  std::string text(bytes.begin(), bytes.end() - 12);
  text += PngChunk("IEND", "abc") + Word(0x7fffffff) + "tEXt" + std::string(8, 'x');
  EXPECT_THAT(Decode(text).rgb, testing::Each(9));
}

// tRNS of a grey PNG names the grey that is transparent.
TEST(ImageFile, GreyThatIsTransparent) {
  for (const int type : {CV_8UC1, CV_16UC1}) {
    cv::Mat picture(1, 3, type, cv::Scalar(200));
    picture.col(1).setTo(7);
    std::vector<std::uint8_t> bytes;
    cv::imencode(".png", picture, bytes);
    const std::string chunk = PngChunk("tRNS", {"\0\7", 2});
    const std::string name = "IDAT";
    const auto at = std::search(bytes.begin(), bytes.end(), name.begin(), name.end()) - 4;
    bytes.insert(at, chunk.begin(), chunk.end());
    EXPECT_THAT(DecodeImage(bytes, true).alpha, testing::ElementsAre(255, 0, 255)) << type;
    EXPECT_THAT(DecodeImage(bytes).alpha, testing::IsEmpty());
  }
}

TEST(ImageFile, WhatTheDecoderRefusesAfterAGoodHeader) {
  EXPECT_EQ(Complaint("P6\n4 4\n255\nshort"), "not a picture that can be decoded");
}

// Truncation at every length: refused, also where the decoder itself would fill in the rest.
TEST(ImageFile, EveryTruncationIsRefused) {
  for (const char* extension : {".png", ".jpg"}) {
    const std::string whole = EncodeNoise(extension, 24, 17);
    EXPECT_EQ(Complaint(whole), "none");
    EXPECT_EQ(Complaint(whole + "some bytes after the end"), "none");
    for (std::size_t length = 0; length < whole.size(); ++length) {
      ASSERT_NE(Complaint(whole.substr(0, length)), "none")
          << extension << " cut off at " << length << " of " << whole.size();
    }
    EXPECT_THAT(Complaint(whole.substr(0, whole.size() * 2 / 3)), testing::StartsWith("truncated"));
  }
}

TEST(ImageFile, EveryFlippedByteOfAPngIsRefused) {
  const std::string whole = EncodeNoise(".png", 6, 5);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::string damaged = whole;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x10);
    ASSERT_NE(Complaint(damaged), "none") << "byte " << i;
  }
}

// Damage within a JPEG: bytes that are overwritten, or missing, and a lost restart marker; padding is none.
TEST(ImageFile, JpegDamagedInTheMiddle) {
  for (const int restart : {0, 3}) {
    for (const int type : {CV_8UC1, CV_8UC3}) {
      cv::Mat picture(77, 91, type);
      cv::randu(picture, 0, 255);
      std::vector<std::uint8_t> bytes;
      cv::imencode(".jpg", picture, bytes, {cv::IMWRITE_JPEG_RST_INTERVAL, restart});
      const std::string whole(bytes.begin(), bytes.end());
      EXPECT_EQ(Complaint(whole), "none");
      EXPECT_EQ(Complaint(whole.substr(0, whole.size() - 2) + std::string(40, '\0') + "\xff\xd9"), "none");
      const std::size_t middle = whole.size() / 2;
      std::string zeros = whole;
      zeros.replace(middle, 100, 100, '\0');
      EXPECT_THAT(Complaint(zeros), testing::StartsWith("damaged JPEG: Corrupt JPEG data"));
      EXPECT_THAT(Complaint(whole.substr(0, middle) + whole.substr(middle + 200)),
                  testing::StartsWith("damaged JPEG: Corrupt JPEG data"));
      if (restart == 0) continue;
      std::string lost = whole;
      const std::size_t marker = whole.find("\xff\xd3", 700);
      ASSERT_NE(marker, std::string::npos);
      EXPECT_THAT(Complaint(lost.erase(marker, 2)), testing::StartsWith("damaged JPEG: Corrupt JPEG data"));
    }
  }
}

TEST(ImageFile, JpegWithAShortThumbnail) {
  const std::string whole = EncodeNoise(".jpg", 24, 17), thumbnail = EncodeNoise(".jpg", 8, 8);
  const std::size_t length = thumbnail.size() + 2;
  std::string application{'\xff', '\xe1', static_cast<char>(length >> 8), static_cast<char>(length & 255)};
  const std::string with_thumbnail = whole.substr(0, 2) + application + thumbnail + whole.substr(2);
  EXPECT_EQ(Complaint(with_thumbnail), "none");
  EXPECT_THAT(Complaint(with_thumbnail.substr(0, with_thumbnail.size() - 2)), testing::StartsWith("truncated"));
}

TEST(ImageFile, LinearValuesOfRadianceAreCoded) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".hdr", cv::Mat(2, 2, CV_32FC3, cv::Scalar(1.5, 0.001, 0.2158605)), bytes);
  const DecodedImage image = DecodeImage(bytes);
  EXPECT_NEAR(image.rgb[0], 128, 3);
  EXPECT_NEAR(image.rgb[1], 3, 3);
  EXPECT_EQ(image.rgb[2], 255);
}

TEST(ImageFile, NotAPicture) {
  EXPECT_EQ(Complaint(""), "the file is empty");
  EXPECT_NE(Complaint("this is no picture"), "none");
  EXPECT_NE(Complaint(std::string(1000, '\0')), "none");
}

// A TGA of 3 x 2 pixels, red to blue, by its header's type, bits and descriptor, with the pixels in the file's order.
std::vector<std::uint8_t> Tga(std::uint8_t type, std::uint8_t bits, std::uint8_t descriptor,
                              const std::vector<std::uint8_t>& rest, std::uint8_t colors = 0) {
  std::vector<std::uint8_t> file = {2,    static_cast<std::uint8_t>(colors > 0),
                                    type, 0,
                                    0,    colors,
                                    0,    24,
                                    0,    0,
                                    0,    0,
                                    3,    0,
                                    2,    0,
                                    bits, descriptor,
                                    'i',  'd'};
  std::ranges::copy(rest, std::back_inserter(file));
  return file;
}

TEST(ImageFile, TgaOfEveryKind) {
  const std::vector<std::uint8_t> rgb = {255, 0, 0, 0, 255, 0, 0,   0,   255,
                                         9,   9, 9, 0, 0,   0, 255, 255, 255};  // rows from the top
  const std::vector<std::uint8_t> from_top = {0, 0, 255, 0, 255, 0, 255, 0, 0, 9, 9, 9, 0, 0, 0, 255, 255, 255};
  const std::vector<std::uint8_t> from_below = {9, 9, 9, 0, 0, 0, 255, 255, 255, 0, 0, 255, 0, 255, 0, 255, 0, 0};
  const std::vector<std::uint8_t> from_right = {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255, 0, 0, 0, 9, 9, 9};
  EXPECT_EQ(Rgb(DecodeImage(Tga(2, 24, 32, from_top))), rgb);
  EXPECT_EQ(Rgb(DecodeImage(Tga(2, 24, 0, from_below))), rgb);
  EXPECT_EQ(Rgb(DecodeImage(Tga(2, 24, 48, from_right))), rgb);
  // Packets: three raw pixels, one raw pixel, a run of two.
  const std::vector<std::uint8_t> packets = {2, 0, 0, 255, 0, 255, 0, 255, 0, 0, 0, 9, 9, 9, 0x81, 7, 7, 7};
  const DecodedImage runs = DecodeImage(Tga(10, 24, 32, packets));
  EXPECT_EQ(Rgb(runs), (std::vector<std::uint8_t>{255, 0, 0, 0, 255, 0, 0, 0, 255, 9, 9, 9, 7, 7, 7, 7, 7, 7}));
  EXPECT_THROW(DecodeImage(Tga(10, 24, 32, {packets.begin(), packets.end() - 1})), std::runtime_error);
  const DecodedImage alpha = DecodeImage(
      Tga(2, 32, 40, {0, 0, 255, 1, 0, 255, 0, 2, 255, 0, 0, 3, 9, 9, 9, 4, 0, 0, 0, 5, 255, 255, 255, 6}), true);
  EXPECT_EQ(Rgb(alpha), rgb);
  EXPECT_EQ(alpha.alpha, (std::vector<std::uint8_t>{1, 2, 3, 4, 5, 6}));
  EXPECT_TRUE(DecodeImage(Tga(2, 32, 32, std::vector<std::uint8_t>(24)), true).alpha.empty()) << "no bits of alpha";
  EXPECT_EQ(Rgb(DecodeImage(Tga(3, 8, 32, {1, 2, 3, 4, 5, 6}))),
            (std::vector<std::uint8_t>{1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 4, 5, 5, 5, 6, 6, 6}));
  const std::vector<std::uint8_t> palette = {0, 0, 255, 0, 255, 0, 0, 1, 0, 1, 1, 0};
  EXPECT_EQ(Rgb(DecodeImage(Tga(1, 8, 32, palette, 2))),
            (std::vector<std::uint8_t>{255, 0, 0, 0, 255, 0, 255, 0, 0, 0, 255, 0, 0, 255, 0, 255, 0, 0}));
  EXPECT_THROW(DecodeImage(Tga(1, 8, 32, {0, 0, 255, 0, 255, 0, 0, 1, 2, 1, 1, 0}, 2)), std::runtime_error);
  const DecodedImage five = DecodeImage(Tga(2, 16, 32, {0, 0x7c, 0xe0, 3, 0x1f, 0, 0, 0, 0, 0, 0xff, 0x7f}));
  EXPECT_EQ(std::vector<std::uint8_t>(five.rgb.begin(), five.rgb.begin() + 9),
            (std::vector<std::uint8_t>{255, 0, 0, 0, 255, 0, 0, 0, 255}));
}

TEST(ImageFile, OtherKindsAreNamed) {
  for (const auto& [bytes, kind] : {std::pair<std::string, std::string>{"DDS |", "DDS"},
                                    {"\x01\xda\x01\x01", "SGI"},
                                    {"\xabKTX 20", "KTX"},
                                    {"GIF89a", "GIF"}}) {
    try {
      DecodeImage({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
      FAIL() << kind;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find(kind), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("convert it to PNG"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace sim::test
