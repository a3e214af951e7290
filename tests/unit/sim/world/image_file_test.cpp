#include "sim/world/image_file.h"

#include <gmock/gmock.h>

#include "tests/unit/sim/world/files.h"

namespace sim::test {
namespace {

DecodedImage Decode(const std::string& bytes) {
  return DecodeImage({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
}

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

TEST(ImageFile, WhatTheDecoderRefusesAfterAGoodHeader) {
  EXPECT_EQ(Complaint("P6\n4 4\n255\nshort"), "not a picture that can be decoded");
}

// Wherever a file is cut off, it is refused: also where the decoder by itself would fill the rest up.
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

TEST(ImageFile, JpegWithAShortThumbnail) {
  const std::string whole = EncodeNoise(".jpg", 24, 17), thumbnail = EncodeNoise(".jpg", 8, 8);
  const std::size_t length = thumbnail.size() + 2;
  std::string application{'\xff', '\xe1', static_cast<char>(length >> 8), static_cast<char>(length & 255)};
  const std::string with_thumbnail = whole.substr(0, 2) + application + thumbnail + whole.substr(2);
  EXPECT_EQ(Complaint(with_thumbnail), "none");
  EXPECT_THAT(Complaint(with_thumbnail.substr(0, with_thumbnail.size() - 2)), testing::StartsWith("truncated"));
}

TEST(ImageFile, NotAPicture) {
  EXPECT_EQ(Complaint(""), "the file is empty");
  EXPECT_NE(Complaint("this is no picture"), "none");
  EXPECT_NE(Complaint(std::string(1000, '\0')), "none");
}

}  // namespace
}  // namespace sim::test
