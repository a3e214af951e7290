// Image sizes in file headers, written by hand here. That decoders read the same sizes is tested by the readers' own
// tests and by tests/fuzz, on files written by OpenCV.
#include "tools/base/limits/picture.h"

#include <gmock/gmock.h>

#include <vector>

namespace limits {
namespace {

using testing::AnyOf;
using testing::HasSubstr;
using testing::StartsWith;

std::string Big(std::uint64_t value, int bytes) {
  std::string text;
  for (int i = bytes; i-- > 0;) text += static_cast<char>(value >> (8 * i));
  return text;
}
std::string Little(std::uint64_t value, int bytes) {
  std::string text;
  for (int i = 0; i < bytes; ++i) text += static_cast<char>(value >> (8 * i));
  return text;
}

std::string Problem(const std::string& file) {
  return PictureProblem({reinterpret_cast<const std::uint8_t*>(file.data()), file.size()});
}

// Headers of each kind of file, for an image of this size.
std::vector<std::pair<std::string, std::string>> Headers(std::uint64_t w, std::uint64_t h) {
  const auto entry = [](int tag, std::uint64_t value) {
    return Little(static_cast<std::uint64_t>(tag), 2) + Little(4, 2) + Little(1, 4) + Little(value, 4);
  };
  const std::string size = std::to_string(w) + " " + std::to_string(h);
  return {
      {"PNG", "\x89PNG\r\n\x1a\n" + Big(13, 4) + "IHDR" + Big(w, 4) + Big(h, 4) + std::string(20, '\0')},
      {"JPEG", "\xff\xd8\xff\xe0" + Big(6, 2) + "JFIF" + "\xff\xff\xc4" + Big(3, 2) + "x" + "\xff\xc2" + Big(11, 2) +
                   "\x08" + Big(h, 2) + Big(w, 2) + std::string(20, '\0')},
      {"BMP", "BM" + std::string(12, '\0') + Little(40, 4) + Little(w, 4) + Little(h, 4)},
      {"BMP from the top", "BM" + std::string(12, '\0') + Little(40, 4) + Little(w, 4) + Little(0u - h, 4)},
      {"old BMP", "BM" + std::string(12, '\0') + Little(12, 4) + Little(w, 2) + Little(h, 2)},
      {"TIFF", std::string("II*\0", 4) + Little(8, 4) + Little(2, 2) + entry(256, w) + entry(257, h)},
      {"WebP", "RIFF" + Little(0, 4) + "WEBPVP8X" + Little(10, 4) + Little(0, 4) + Little(w - 1, 3) + Little(h - 1, 3)},
      {"PNM", "P6\n# a comment\n" + size + "\n255\n"},
      {"HDR", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(h) + " +X " + std::to_string(w) + "\n"},
  };
}

TEST(Picture, HeadersOfUsualSizesPass) {
  for (const auto& [kind, header] : Headers(640, 480)) EXPECT_EQ(Problem(header), "") << kind;
}

TEST(Picture, EachKindIsBounded) {
  for (const auto& [kind, header] : Headers(40000, 480)) {
    EXPECT_EQ(Problem(header), "40000 x 480 pixels: a side may have 32768 at most") << kind;
  }
  for (const auto& [kind, header] : Headers(16384, 16384)) {
    EXPECT_THAT(Problem(header), HasSubstr("16384 x 16384 pixels: a picture may have 134217728 at most")) << kind;
  }
  for (const auto& [kind, header] : Headers(8192, 8192)) {
    EXPECT_THAT(Problem(header), HasSubstr("8192 x 8192 pixels in ")) << kind << ": so many for so few bytes";
  }
}

TEST(Picture, CutOffHeadersTellNoSize) {
  for (const auto& [kind, header] : Headers(640, 480)) {
    for (std::size_t length = 11; length < 18; ++length) {
      const std::string problem = Problem(header.substr(0, length));
      EXPECT_TRUE(problem == "its header has no size" || problem.starts_with("not a picture that"))
          << kind << " " << length << ": " << problem;
    }
  }
}

// Scale of PNM: decoders do not rescale its numbers, so that any other largest value gives a dark image.
TEST(Picture, ScaleOfPnmIsThatOfWholeBytes) {
  for (const char kind : {'2', '3', '5', '6'}) {
    const std::string begin = std::string("P") + kind + " 4 4 ";
    EXPECT_EQ(Problem(begin + "255\n"), "");
    EXPECT_EQ(Problem(begin + "\n# 16 bits\n65535\n"), "");
    EXPECT_EQ(Problem(begin + "127\n"),
              "a PNM picture whose largest value is 127, not 255 or 65535: convert it to PNG");
    EXPECT_THAT(Problem(begin + "1023\n"), HasSubstr("is 1023"));
  }
  for (const char kind : {'1', '4'}) EXPECT_EQ(Problem(std::string("P") + kind + "\n4 4\n7"), "");
}

TEST(Picture, TilesOfTiffCount) {
  const auto entry = [](int tag, std::uint64_t value) {
    return Little(static_cast<std::uint64_t>(tag), 2) + Little(4, 2) + Little(1, 4) + Little(value, 4);
  };
  const std::string file = std::string("II*\0", 4) + Little(8, 4) + Little(4, 2) + entry(256, 8) + entry(257, 8) +
                           entry(322, 60000) + entry(323, 60000);
  EXPECT_THAT(Problem(file), StartsWith("60000 x 60000 pixels"));
}

TEST(Picture, TiffOfLogLuvIsNotRead) {
  const auto entry = [](int tag, std::uint64_t value) {
    return Little(static_cast<std::uint64_t>(tag), 2) + Little(3, 2) + Little(1, 4) + Little(value, 4);
  };
  for (const std::uint64_t coding : {1, 5, 34676, 34677}) {
    const std::string problem = Problem(std::string("II*\0", 4) + Little(8, 4) + Little(3, 2) + entry(256, 8) +
                                        entry(257, 8) + entry(259, coding));
    EXPECT_EQ(problem.starts_with("a TIFF coded as LogLuv"), coding > 5) << coding << problem;
  }
}

TEST(Picture, OtherKindsAreNotRead) {
  for (const std::string& file :
       {std::string("GIF89a") + std::string(20, 'x'), std::string("\x59\xa6\x6a\x95") + std::string(40, '\0'),
        std::string("\0\0\0\x0cjP  \r\n", 10) + std::string(40, '\0'), std::string("<VRTDataset>"), std::string()}) {
    EXPECT_THAT(Problem(file), AnyOf(HasSubstr("not a picture that is read here"), HasSubstr("which is not read")))
        << file;
  }
}

}  // namespace
}  // namespace limits
